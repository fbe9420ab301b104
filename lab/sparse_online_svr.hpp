// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kelpie/core/setting.hpp"
#include "kelpie/learner/regressor.hpp"
#include "lab/kernel_inverse.hpp"
#include "svr/dual_problem.hpp"
#include "svr/path_solver.hpp"
#include "svr/sample_store.hpp"
#include "svr/svr_function.hpp"

namespace kelpie::lab {

/// Inputs and targets are standardised before they come here (model/scaled.hpp), so ε and C are in
/// standard deviations of the target.
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

  /// Throws InputError naming the field, its value and what would be right.
  void validate() const;
};

/// The table of all fields.
std::span<const Setting<SparseOnlineSvrSettings>> sparse_online_svr_fields();

/// SOSVR (Nguyen-Tuong, Schölkopf & Peters 2009; Nguyen-Tuong & Peters 2011) for one axis: ε-SVR on
/// a dictionary of linearly independent samples. A sample enters when its independence
/// δ = κ(x, x) − kᵀK⁻¹k exceeds η. When the dictionary is full, the sample with the least
/// δ_i exp(−age²/2h²), h = fade_s, makes room, provided the newcomer has more.
/// The papers keep one inverse for each sample left out, O(n³) numbers; here the one inverse of the
/// whole gives every δ_i from its diagonal, at O(n²) in memory and for each change.
/// Targets play no part in who stays: that is the method, not an omission.
class SparseOnlineSvr final : public OnlineRegressor {
 public:
  /// Allocates what it ever needs. Throws InputError on settings that don't validate.
  SparseOnlineSvr(std::size_t inputs, const SparseOnlineSvrSettings& settings);

  /// A sample that isn't independent is `explained`. Cost O(n²), and O(n) per solver iteration.
  Decision update(std::span<const double> z, double y, double t) override;

  /// By the model in service; before there is one, the mean of the targets so far.
  double predict(std::span<const double> z) const override;

  Status status() const override;

  const SparseOnlineSvrSettings& settings() const { return settings_; }
  const SampleStore& dictionary() const { return samples_; }
  const DualProblem& problem() const { return problem_; }
  const KernelInverse& inverse() const { return inverse_; }

  /// How often the inverse had to be made afresh.
  std::int64_t remakes() const { return remakes_; }

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
  double mean_ = 0.0;  ///< of the valid targets, for the time before there is a model
  std::int64_t valid_samples_ = 0;
  std::int64_t remakes_ = 0;
  Status status_;
};

}  // namespace kelpie::lab
