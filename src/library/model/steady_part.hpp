// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kelpie/model/open_loop.hpp"
#include "kelpie/motion/term_set.hpp"
#include "learner/triangular_fit.hpp"

namespace kelpie {

/// The equation of motion of one axis: the acceleration wᵀφ + w₀ of one velocity, with its error.
struct SteadyModel {
  std::size_t state = 0;        ///< place of the velocity among the inputs
  std::vector<double> weights;  ///< w, then w₀, in the units of the log; empty: unknown
  double error = 0.0;           ///< root mean square of the acceleration's error, one step ahead
  double error_time_s = 0.0;    ///< s, up to 10, time constant τ of the error: e^(−t/τ)
  double learned_error = 0.0;   ///< root mean square of the learned model's error, one step ahead
  double noise = 0.0;           ///< standard deviation of a measured velocity
  std::vector<Extremes> seen;   ///< every input's range

  bool ready() const { return !weights.empty(); }

  /// The acceleration at the terms `phi`. Requires ready().
  double acceleration(std::span<const double> phi) const;
};

/// The steady part of one axis: the equation of motion, fitted to all samples since the start or
/// since the last change of the vehicle. The fit is to steps of the velocity,
///
///     ν(t') − ν(t) = ∫ wᵀφ + w₀ dt ≈ (t' − t) (wᵀ (φ + φ')/2 + w₀),
///
/// which are more exact for slow motion than accelerations, which are filtered and delayed.
/// Steps across a gap in time (kLongestStep), and jumps of the velocity beyond any acceleration (a
/// cut in the log), are left out.
///
/// Terms beyond TermSet::without_products(), the products of command and velocity, are expected to
/// make up a tenth of the accelerations: w_k √(mean φ_k²) ~ N(0, (0.1 ẏ_rms)²), against errors with
/// the measured size and duration (ridge regression, Hoerl & Kennard 1970, by Bayes' rule). Large
/// errors so raise the evidence needed for products. Allocates in the constructor only.
class SteadyPart {
 public:
  /// `state`: the input with the targets as its derivative.
  SteadyPart(TermSet terms, std::size_t inputs, std::size_t state);

  /// Learns from one valid sample: raw inputs, the acceleration and the time [s]. Cost O(m²) for
  /// m terms.
  void observe(std::span<const double> x, double y, double t);

  /// Adds the error of the learned model at a sample before learning.
  void observe_learned(double error);

  /// After a change of the vehicle: earlier steps count as 100 steps from now on, and serve until
  /// new steps outweigh them. Without a model yet, discards everything.
  void restart();

  void visit(Archive& archive);  ///< core/archive.hpp

  std::int64_t steps() const { return fit_.rows(); }

  /// The model so far. Not ready() before 200 steps and ten more seconds. Allocates.
  SteadyModel model() const;

 private:
  bool known() const { return blocks_ > 0; }
  double error_time_s() const;
  double prior_of_products() const;
  void learn_step(double change, double y, double step_s);
  void learn_error(double error, double step_s);

  TermSet terms_;
  std::size_t state_;
  std::vector<Extremes> seen_;  ///< one per input
  TriangularFit fit_;
  std::vector<double> phi_;  ///< of the last sample, and a 1
  std::vector<double> next_;
  double velocity_ = 0.0;
  double target_ = 0.0;
  double time_s_ = 0.0;
  double usual_step_s_ = 0.0;
  double target_square_ = 0.0;   ///< mean of the targets' squares
  double error_square_ = 0.0;    ///< fading mean of the errors' squares
  double block_square_ = 0.0;    ///< fading mean of squared means over ten seconds
  double block_sum_ = 0.0;       ///< ∫ error dt of the block at hand,
  double block_s_ = 0.0;         ///< and its duration
  double noise_square_ = 0.0;    ///< fading mean of squared unexplained steps
  double learned_square_ = 0.0;  ///< fading mean of the learned model's squared errors
  std::int64_t learned_ = 0;
  std::int64_t errors_ = 0;
  std::int64_t blocks_ = 0;
  std::int64_t samples_ = 0;
};

}  // namespace kelpie
