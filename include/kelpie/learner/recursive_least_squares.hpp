// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "kelpie/core/scaling.hpp"
#include "kelpie/core/setting.hpp"
#include "kelpie/motion/term_set.hpp"
#include "kelpie/svr/regressor.hpp"

namespace kelpie {

class TriangularFit;

/// Settings of RecursiveLeastSquares.
struct RecursiveLeastSquaresSettings {
  int velocities = 3;   ///< number of velocities, the first inputs; the rest: thruster speeds
  double lambda = 1.0;  ///< λ: weight of a sample relative to the next sample
  double huber = 0.0;   ///< limit of full weight [usual errors]; 0: no limit
  double prior = 0.1;   ///< ρ: prior information of a coefficient [samples]

  /// Throws InputError with field, value and valid range.
  void validate() const;
};

/// The table of the fields.
std::span<const Setting<RecursiveLeastSquaresSettings>> recursive_least_squares_fields();

/// Recursive least squares with exponential forgetting on Fossen's terms φ (the set `fossen` of
/// TermSet and the constant 1, last), one axis, raw units:
///
///     θ = argmin Σ_i λ^(n−i) (y_i − θᵀφ_i)² + prior
///
/// A TriangularFit (learner/triangular_fit.hpp: prior, accuracy) with three additions:
/// - forgetting: every sample multiplies the weights of the earlier samples by λ.
/// - bound: while P_kk q_k > 1/ρ, column k is not forgotten and θ does not move. P therefore stays
///   bounded under weak excitation (checked every 16 samples: up to a factor λ⁻¹⁶). Under ample
///   excitation the result is exact exponential forgetting.
/// - huber: a residual |e| > huber · s has the weight huber · s / |e|. s is 1.4826 times the median
///   of the last 64 absolute errors before learning; the first 64 samples have full weight.
class RecursiveLeastSquares final : public OnlineRegressor {
 public:
  /// The values of φ, on the stack.
  using Terms = ShortVector<kMostTerms + 1>;

  /// For named inputs. Throws InputError on settings that do not validate, on fewer inputs than
  /// velocities, more than kMostInputs inputs, or more than kMostTerms terms. Allocates here only.
  RecursiveLeastSquares(std::span<const std::string> inputs,
                        const RecursiveLeastSquaresSettings& settings);

  /// For given terms of `inputs` inputs, and 1; ignores the velocities in the settings. Throws
  /// InputError on settings that do not validate. Allocates here only.
  RecursiveLeastSquares(std::size_t inputs, TermSet terms,
                        const RecursiveLeastSquaresSettings& settings);

  RecursiveLeastSquares(RecursiveLeastSquares&& other) noexcept;
  RecursiveLeastSquares& operator=(RecursiveLeastSquares&& other) noexcept;
  ~RecursiveLeastSquares() override;

  /// Inputs in the units of the log. A sample whose terms' squares overflow is invalid. Cost O(m²)
  /// for m terms, and O(m³) at every 16th sample with λ < 1.
  Decision update(std::span<const double> x, double y, double t) override;

  double predict(std::span<const double> x) const override;
  Status status() const override { return status_; }

  /// φ at a sample. Requires a value for every input. Allocates nothing.
  Terms terms(std::span<const double> x) const;
  std::span<const double> estimates() const;  ///< θ, target unit per term's

  /// P_kk in the units of the terms; infinite for a term without excitation. Allocates.
  std::vector<double> variances() const;

 private:
  static constexpr std::size_t kWindow = 64;

  double weight_of(double error) const;
  void forget();
  void find_weak_terms();

  RecursiveLeastSquaresSettings settings_;
  std::size_t inputs_;
  TermSet terms_;
  std::unique_ptr<TriangularFit> fit_;
  std::vector<double> keep_;  ///< √λ, or 1 for a held column
  std::array<double, kWindow> errors_{};
  std::int64_t samples_ = 0;
  Status status_;
};

}  // namespace kelpie
