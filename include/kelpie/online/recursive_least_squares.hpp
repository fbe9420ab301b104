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
#include "kelpie/online/regressor.hpp"

namespace kelpie {

class TriangularFit;

/// What RecursiveLeastSquares is told.
struct RecursiveLeastSquaresSettings {
  int velocities = 3;   ///< the first inputs are velocities, the rest are thruster speeds
  double lambda = 1.0;  ///< λ: weight of the past against one sample less of age
  double huber = 0.0;   ///< usual errors beyond which a sample counts less; 0: all count whole
  double prior = 0.1;   ///< ρ: the least that is known of a coefficient, in samples

  /// Throws InputError naming the field, its value and what would be right.
  void validate() const;
};

/// The table of all fields.
std::span<const Setting<RecursiveLeastSquaresSettings>> recursive_least_squares_fields();

/// Recursive least squares with exponential forgetting on Fossen's terms φ (the set `fossen` of
/// TermSet and the constant 1, last), one axis, raw units:
///
///     θ = argmin Σ_i λ^(n−i) (y_i − θᵀφ_i)² + prior
///
/// A TriangularFit, which tells of its prior and accuracy, with three things more:
/// - forgetting: a sample counts λ times as much once another has come.
/// - bound: while P_kk q_k > 1/ρ, column k is not forgotten, and θ stays where it is. So under weak
///   excitation P can't blow up (looked at every 16 samples: by more than λ⁻¹⁶). With ample
///   excitation, what is left is exact exponential forgetting.
/// - huber: a sample with a residual e beyond huber · s counts huber · s / |e| times, s = 1.4826
///   times the median of the last 64 absolute errors before learning; until there are as many, all
///   count whole.
class RecursiveLeastSquares final : public OnlineRegressor {
 public:
  /// The values of φ, on the stack.
  using Terms = ShortVector<kMostTerms + 1>;

  /// Takes the inputs' names. Throws InputError on settings that don't validate, on fewer inputs
  /// than velocities, more than kMostInputs, or more than kMostTerms terms. Allocates what it ever
  /// needs.
  RecursiveLeastSquares(std::span<const std::string> inputs,
                        const RecursiveLeastSquaresSettings& settings);

  /// On other terms of so many inputs, and 1; the velocities in the settings don't matter then.
  /// Throws InputError on settings that don't validate. Allocates what it ever needs.
  RecursiveLeastSquares(std::size_t inputs, TermSet terms,
                        const RecursiveLeastSquaresSettings& settings);

  RecursiveLeastSquares(RecursiveLeastSquares&& other) noexcept;
  RecursiveLeastSquares& operator=(RecursiveLeastSquares&& other) noexcept;
  ~RecursiveLeastSquares() override;

  /// Inputs in the log's own units. Invalid also when a term's square overflows. Cost O(m²) for m
  /// terms, and O(m³) at every 16th sample where λ < 1.
  Decision update(std::span<const double> x, double y, double t) override;

  double predict(std::span<const double> x) const override;
  Status status() const override { return status_; }

  /// φ at a sample. Requires a value for every input. Allocates nothing.
  Terms terms(std::span<const double> x) const;
  std::span<const double> estimates() const;  ///< θ, target unit per term's

  /// P_kk in the terms' units; infinite for a term never excited. Allocates.
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
  std::vector<double> keep_;  ///< √λ, or 1 where a column is held
  std::array<double, kWindow> errors_{};
  std::int64_t samples_ = 0;
  Status status_;
};

}  // namespace kelpie
