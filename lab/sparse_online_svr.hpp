// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kelpie/core/setting.hpp"
#include "kelpie/svr/regressor.hpp"
#include "lab/kernel_inverse.hpp"
#include "svr/dual_problem.hpp"
#include "svr/path_solver.hpp"
#include "svr/sample_store.hpp"
#include "svr/svr_function.hpp"

namespace kelpie::lab {

/// For standardised inputs and targets (model/first_scale.hpp): ε and C are in standard deviations
/// of the target.
struct SparseOnlineSvrSettings {
  int dictionary = 300;          ///< samples kept at most
  double threshold = 1e-3;       ///< η: independence above which a sample enters
  double fade_s = 600.0;         ///< age at which independence has faded to exp(−½) [s]
  double ridge = 1e-6;           ///< λ of the inverse of K + λI
  double epsilon = 0.1;          ///< ε: half width of the tube
  double c = 10.0;               ///< C: bound of a weight
  double gamma = 0.15;           ///< κ = exp(−γ |z − z'|²)
  double tolerance = 1e-3;       ///< KKT gap up to which a model is served
  int max_iterations = 100'000;  ///< of the solver, for one solve

  /// Throws InputError with the field out of range.
  void validate() const;
};

/// The table of all fields.
std::span<const Setting<SparseOnlineSvrSettings>> sparse_online_svr_fields();

/// SOSVR (Nguyen-Tuong, Schölkopf & Peters 2009; Nguyen-Tuong & Peters 2011) for one axis: ε-SVR on
/// a dictionary of linearly independent samples. A sample enters when its independence
/// δ = κ(x, x) − kᵀK⁻¹k exceeds η. When the dictionary is full, the sample with the least
/// δ_i exp(−age²/2h²), h = fade_s, makes room, provided the newcomer has more.
/// The papers keep an inverse for each sample left out, O(n³) numbers; here the diagonal of a
/// single inverse gives every δ_i, at O(n²) in memory and for each change. By the method, targets
/// do not influence the choice of samples.
class SparseOnlineSvr final : public OnlineRegressor {
 public:
  /// Makes every allocation. Throws InputError on settings out of range.
  SparseOnlineSvr(std::size_t inputs, const SparseOnlineSvrSettings& settings);

  /// A dependent sample is `explained`. Cost O(n²), and O(n) per solver iteration.
  Decision update(std::span<const double> z, double y, double t) override;

  /// By the model in service; without a model, the mean of the targets so far.
  double predict(std::span<const double> z) const override;

  Status status() const override;

  const SampleStore& dictionary() const { return samples_; }
  const DualProblem& problem() const { return problem_; }
  const KernelInverse& inverse() const { return inverse_; }

 private:
  void include(Decision& decision, std::span<const double> z, double y, double t);
  void collect(std::span<const double> z, double y, double t);
  void remove(std::size_t i);
  void train(Decision& decision);
  bool make_room(Decision& decision, double independence, double now);
  double log_worth(std::size_t i, double now) const;

  SparseOnlineSvrSettings settings_;
  SquaredExponential kernel_;
  SampleStore samples_;
  std::vector<double> time_;
  std::vector<double> row_;
  DualProblem problem_;
  KernelInverse inverse_;
  PathSolver solver_;
  SvrFunction model_;
  SolveReport solved_{.converged = true};
  double mean_ = 0.0;  ///< of the valid targets, as long as no model is in service
  std::int64_t valid_samples_ = 0;
  Status status_;
};

}  // namespace kelpie::lab
