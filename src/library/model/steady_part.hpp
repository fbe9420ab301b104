// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kelpie/model/open_loop.hpp"
#include "kelpie/motion/term_set.hpp"
#include "learner/triangular_fit.hpp"
#include "model/command_gain.hpp"
#include "model/open_loop_practice.hpp"

namespace kelpie {

/// The equation of motion of one axis, the acceleration wᵀφ + w₀ of one velocity, with its error
/// and with what practice found of rollouts.
struct SteadyModel {
  std::size_t state = 0;        ///< place of the velocity among the inputs
  std::vector<double> weights;  ///< w, then w₀, in the units of the log; empty: unknown
  double share = 0.5;           ///< in the mixture with the learned model, 0 to 1
  double error = 0.0;           ///< root mean square of the acceleration's error, one step ahead
  double error_time_s = 0.0;    ///< s, up to 10, time constant τ of the error: e^(−t/τ)
  double noise = 0.0;           ///< standard deviation of a measured velocity
  ByAge off{};                  ///< OpenLoop::off
  ByAge kept{};                 ///< OpenLoop::kept
  std::vector<Extremes> seen;   ///< every input's range

  bool ready() const { return !weights.empty(); }

  /// The acceleration at the terms `phi`. Requires ready().
  double acceleration(std::span<const double> phi) const;
};

/// The steady part of a vehicle: the equations of motion, fitted to all samples since the start or
/// since the last change of the vehicle, with practice in open loop. Samples are averaged over
/// steps of 0.2 s or more. The fit is to the velocity's change over a window of time,
///
///     y_k = ν_k − ν_(k−1) + λ y_(k−1),   f_k = (t_k − t_(k−1)) (φ_k + φ_(k−1))/2 + λ f_(k−1),
///     y_k ≈ wᵀf_k,                       λ = e^(−(t_k − t_(k−1))/T),
///
/// which is more exact for slow motion than accelerations, which are filtered and delayed. T is
/// matched to the noise of velocity: a step of noisy velocities has an error that is a moving
/// average, and the filter whitens the error, as in the innovations of a Kalman filter (Åström
/// 1970, ch. 6). T follows the data: of a second filter with 2T, the lag-one correlation of errors
/// of the axis with the least correlation is brought to 0, between one step and 20 s. Without
/// noise, one step is fitted at a time.
/// Nothing is fitted across a gap in time (kLongestStep) or a cut in the log, a jump of a velocity
/// beyond any acceleration and beyond the noise of velocity.
///
/// Terms beyond TermSet::without_products(), products of command and velocity, are expected to make
/// up a tenth of the accelerations: w_k √(mean φ_k²) ~ N(0, (0.1 ẏ_rms)²), against errors with the
/// measured size and correlation (ridge regression, Hoerl & Kennard 1970, by Bayes' rule). Large
/// errors so raise the evidence needed for these terms. Allocates in the constructor only.
class SteadyPart {
 public:
  /// `states`: the inputs with the targets as their derivatives; `attitude` moves with them.
  SteadyPart(TermSet terms, std::size_t inputs, std::vector<std::size_t> states,
             AttitudeMotion attitude = {});

  /// Learns from one valid sample: raw inputs, accelerations and the time [s]. `learned`: the
  /// learned model, for practice; empty: none yet. Cost O(m²) for m terms and two evaluations of
  /// either model, at most every 0.2 s, and O(inputs) for other samples.
  void observe(std::span<const double> x, std::span<const double> y, double t,
               const Accelerations& learned = {});

  /// After a change of the vehicle: earlier steps count as 25 s from now on, and serve until new
  /// steps outweigh them. Without a model yet, discards everything.
  void restart();

  /// Commands have other effects: the fit holds for the commands times these factors. Without
  /// effect where a term is no power of the command.
  void amplify(std::span<const CommandGain> gains);

  void visit(Archive& archive);  ///< core/archive.hpp

  std::int64_t steps() const { return fit_.rows(); }
  double window_s() const;  ///< T.

  /// The model of an axis so far. Not ready() before three steps per term and ten more seconds.
  /// Allocates.
  SteadyModel model(std::size_t axis) const;

 private:
  // Errors of a fit in succession.
  struct Errors {
    double last = 0.0;    ///< NaN: none
    double before = 0.0;  ///< the error before the last; NaN: none
    double square = 0.0;  ///< fading mean of squares
    double lagged = 0.0;  ///< fading mean of products with the error before
    double correlation() const { return square > 0.0 ? lagged / square : 0.0; }
    void add(double error, std::int64_t count);
    void visit(Archive& archive);
  };
  // A sum over the last window: of changes of velocity and of terms.
  struct Window {
    std::vector<double> y;
    std::vector<double> phi;
    std::vector<Errors> errors;  ///< per axis
    Window(std::size_t axes, std::size_t terms) : y(axes), phi(terms), errors(axes) {}
    void clear();
    void visit(Archive& archive);
  };
  struct Axis {
    double target_square = 0.0;  ///< mean of the targets' squares
    double error_square = 0.0;   ///< fading mean of the squares of the acceleration's errors
    double block_square = 0.0;   ///< fading mean of squared means over ten seconds
    double block_sum = 0.0;      ///< ∫ error dt of the block at hand
    double noise_square = 0.0;   ///< fading mean of squared unexplained changes of velocity
    double error_time_s() const;
  };

  bool known() const { return blocks_ > 0; }
  bool joins(std::span<const double> x, std::span<const double> y, double step_s);
  void close_step(const Accelerations& learned);
  void break_off();
  void learn_step(double step_s);
  void slide(Window& window, double keep, double step_s);
  void match_window();
  void learn_errors(double step_s);
  void practise(const Accelerations& learned);
  void hold_products(TriangularFit& fit, std::size_t axis) const;

  TermSet terms_;
  std::vector<std::size_t> states_;
  std::vector<Extremes> seen_;  ///< one per input
  std::vector<Axis> axes_;
  TriangularFit fit_;
  Window window_;
  Window twice_;              ///< with 2T
  double gain_ = 1.0;         ///< 1 − λ of a usual step with 2T
  std::vector<double> raw_;   ///< mean squares of the terms
  std::vector<double> phi_;   ///< of the last step, and a 1
  std::vector<double> next_;  ///< of the present step
  // The step at hand: sums over its samples.
  std::vector<double> x_sum_, y_sum_;
  double t_sum_ = 0.0;
  double begin_s_ = 0.0;
  std::int64_t count_ = 0;
  // The last step: means.
  std::vector<double> x_, y_, velocity_;
  double time_s_ = 0.0;
  double usual_step_s_ = 0.0;
  bool joined_ = false;  ///< to the step before
  // The last sample.
  std::vector<double> x_last_, y_last_;
  double last_s_ = 0.0;
  double usual_sample_s_ = 0.0;
  double block_s_ = 0.0;  ///< duration of the block of errors at hand
  std::int64_t errors_ = 0;
  std::int64_t blocks_ = 0;
  std::int64_t samples_ = 0;
  OpenLoopPractice practice_;
  double practised_s_ = 0.0;     ///< time of the last sample in practice
  std::vector<double> weights_;  ///< of the steady part in practice: of all axes
  TriangularFit held_;           ///< scratch: the fit with the products of one axis held
  std::vector<double> scratch_;  ///< terms of one evaluation, and a 1
};

}  // namespace kelpie
