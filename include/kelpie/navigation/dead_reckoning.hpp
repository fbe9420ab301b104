// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>

#include "kelpie/model/open_loop.hpp"
#include "kelpie/model/rollout.hpp"

namespace kelpie {

/// Settings of a DeadReckoning.
struct DeadReckoningSettings {
  double step_s = 0.25;  ///< s, longest step of the integrator
  CommandPath between = CommandPath::linear;
  /// The first three states are surge, sway [m/s] and yaw rate [rad/s]: estimates position, heading
  /// and current too.
  bool planar = true;
  /// Standard deviation of the current [m/s] at the start; 0: no current.
  double current_m_s = 0.1;
  /// Random walk of the current [m/s/√s].
  double current_wander = 0.001;
  /// Duration of simulated outages [s] while velocities are measured; 0: none.
  double practice_s = 20.0;

  void validate(std::size_t states) const;  ///< Throws InputError naming the field.
};

/// The way of the vehicle since the start of an outage, in the frame of heading() = 0.
struct Drift {
  std::array<double, 2> position_m{};     ///< forward and to the left at heading 0
  std::array<double, 4> covariance_m2{};  ///< of the position's error, row-major
};

/// Velocities for a navigator from a learned model: filtered measurements, and predictions during
/// outages of the measurements.
///
///     DeadReckoning reckoning(open_loop(model.trained(), OpenLoopPart::steady));
///     reckoning.update(x, t);        // at every sample; NaN: velocity not measured
///     reckoning.velocity(0);         // and deviation(0), drift(), current(), silent_s()
///
/// An extended Kalman filter of the velocities ν, of the present error d of the model (a
/// first-order Gauss-Markov acceleration per axis with size and duration of the model's errors:
/// OpenLoop::error and error_time_s), of a current c (a slow random walk), of heading and position:
///
///     ν̇ = a(ν − Rᵀc, n) + d − ω × Rᵀc,   ḋ = −d/τ + w,   ċ = w_c,   ṗ = R ν,   ψ̇ = r.
///
/// In an outage d fades and c stays. The next measurement is weighted by both covariances. A
/// measurement beyond three standard deviations moves the estimate by three standard deviations at
/// most, so that neither an outlier nor a long outage makes the estimate jump; the fourth such
/// measurement in succession is accepted as measured.
///
/// Calibration: while velocities are measured, outages are simulated in parallel, and the process
/// noise is set so that the predicted covariance matches the errors at the end of the outages
/// (noise_factor()); the ellipse of drift() is widened by age as practised outages ask. Three
/// filters run: without a current, with a constant current, with a random walk. From the fifth
/// outage on, the filter with the least error is used; a richer hypothesis needs less than 0.7 of
/// the error of a simpler hypothesis.
///
/// Velocities stay within the range seen, widened by half its width.
/// Cost: 4 + 2 · states accelerations per step and filter, twice with simulated outages. Allocates
/// in the constructor and in copies only. One thread at a time.
class DeadReckoning {
 public:
  /// Throws InputError on settings that don't validate, and more than six states.
  explicit DeadReckoning(const OpenLoop& model, const DeadReckoningSettings& settings = {});
  ~DeadReckoning();
  DeadReckoning(const DeadReckoning& other);                 ///< With a model of its own.
  DeadReckoning(DeadReckoning&& other) noexcept;             ///< `other` is empty then.
  DeadReckoning& operator=(const DeadReckoning& other);      ///< As the copy.
  DeadReckoning& operator=(DeadReckoning&& other) noexcept;  ///< As above.

  /// Advances to the time t [s] and the inputs x of the model; NaN: velocity not measured. A
  /// command that isn't finite keeps its previous value. `covariance` of the measured velocities,
  /// row-major over all states; default: the noise known to the model. Starts at the first sample
  /// with all velocities. Where time doesn't advance, only the measurement counts. Throws
  /// InputError on spans of another size, a time that isn't finite, and a step of more than
  /// Rollout::kMostSteps steps; the state is unchanged then.
  void update(std::span<const double> x, double t, std::span<const double> covariance = {});

  /// Adds a measured heading [rad] with its standard deviation, with the sign of the yaw rate.
  /// Without a measured heading, heading() starts at 0. Throws InputError with planar off, on
  /// numbers that aren't finite, and on a deviation <= 0.
  void measured_heading(double heading, double deviation);

  std::size_t states() const;  ///< Number of velocities.
  bool started() const;        ///< After the first sample with all velocities.
  double silent_s() const;     ///< Time since a velocity except the yaw rate was measured.
  double velocity(std::size_t state) const;  ///< Over ground, in the unit of the log.
  double covariance(std::size_t row, std::size_t column) const;  ///< Covariance of two velocities.
  double deviation(std::size_t state) const;    ///< Standard deviation of a velocity.
  double disturbance(std::size_t state) const;  ///< d, in the target's unit.
  double heading() const;                       ///< rad; 0 where planar is off.
  std::array<double, 2> current() const;        ///< c [m/s], in the axes of Drift.
  Drift drift() const;                          ///< Zero while velocities are measured.
  /// Factor on the variance of the model's errors one step ahead.
  double noise_factor() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace kelpie
