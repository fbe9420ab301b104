// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>

#include "kelpie/model/open_loop.hpp"
#include "kelpie/model/rollout.hpp"

namespace kelpie {

/// What a DeadReckoning is told.
struct DeadReckoningSettings {
  double step_s = 0.25;  ///< the longest step of the integrator
  CommandPath between = CommandPath::linear;
  /// The first three states are surge, sway [m/s] and yaw rate [rad/s]: position, heading and the
  /// current are estimated, too.
  bool planar = true;
  /// Usual size of a current [m/s] before anything is known of it; 0: there is none.
  double current_m_s = 0.1;
  /// How far a current wanders within a second [m/s/√s].
  double current_wander = 0.001;
  /// Length of the outages [s] that are practised while velocities are measured; 0: none.
  double practice_s = 20.0;

  void validate(std::size_t states) const;  ///< Throws InputError naming the field.
};

/// Where the vehicle went since its velocities fell silent, in the frame of heading() = 0.
struct Drift {
  std::array<double, 2> position_m{};     ///< ahead and to the left at heading 0
  std::array<double, 4> covariance_m2{};  ///< of its error, row-major
};

/// A navigator's velocities from a learned model: measured ones are filtered while they come, and
/// predicted while they don't.
///
///     DeadReckoning reckoning(open_loop(model.trained()));
///     reckoning.update(x, t);        // at every sample: a velocity that isn't measured is NaN
///     reckoning.velocity(0);         // and deviation(0), drift(), current(), silent_s()
///
/// An extended Kalman filter of the velocities ν, of what the model misses at present, d (a
/// first-order Gauss-Markov acceleration per axis, as large and as lasting as the model's errors
/// were: OpenLoop::error and error_time_s), of a current c that is constant but for its wandering,
/// of heading and position:
///
///     ν̇ = a(ν − Rᵀc, n) + d − ω × Rᵀc,   ḋ = −d/τ + w,   ċ = w_c,   ṗ = R ν,   ψ̇ = r.
///
/// In an outage d fades and c stays. A measurement after it counts by both covariances; one further
/// off than it should ever be moves the estimate by three of its standard deviations at most, so
/// that neither a wild ping nor a long outage makes it jump; the fourth of them in a row is taken
/// over as it is, since the vehicle really is there.
///
/// Honest: while all is measured, outages are practised beside it, one after the other, and the
/// process noise is made as large as the errors at their end ask for (noise_factor()). Three such
/// filters run, without a current, with one that is constant and one that wanders. From the fifth
/// outage on, that of the least error is believed; a richer one has to have less than 0.7 of it.
///
/// The model is asked for the end of its fade (open_loop()): its steady part, or the learned model
/// where it never fades. Velocities stay within what was seen, widened by half its width.
/// Cost: 4 + 2 · states accelerations per step and filter, as many again for practice. Allocates in
/// the constructor and in copies only. One thread at a time.
class DeadReckoning {
 public:
  /// Throws InputError on settings that don't validate, and more than six states.
  explicit DeadReckoning(const OpenLoop& model, const DeadReckoningSettings& settings = {});
  ~DeadReckoning();
  DeadReckoning(const DeadReckoning& other);      ///< Goes on by itself, with a model of its own.
  DeadReckoning(DeadReckoning&& other) noexcept;  ///< Leaves nothing that can be used.
  DeadReckoning& operator=(const DeadReckoning& other);      ///< As the copy.
  DeadReckoning& operator=(DeadReckoning&& other) noexcept;  ///< As above.

  /// Goes on to the time t [s], where the inputs are x: as the model takes them, NaN where a
  /// velocity isn't measured. A command that isn't finite is taken to be as before. `covariance`
  /// of the measured velocities, row-major of all states; without it the noise that the model
  /// found. Begins at the first sample with all velocities. Where time doesn't go on, nothing
  /// passes but the measurement. Throws InputError on spans of another size, a time that isn't
  /// finite, and a step of more than Rollout::kMostSteps steps; then nothing has changed.
  void update(std::span<const double> x, double t, std::span<const double> covariance = {});

  /// Takes in a heading [rad] with its standard deviation, counted as yaw rates are (with a yaw
  /// rate to port as positive, to port). Without any, heading() is 0 at the start.
  /// Throws InputError where planar is off, and on numbers that aren't finite or a deviation <= 0.
  void measured_heading(double heading, double deviation);

  std::size_t states() const;  ///< Velocities of the model.
  bool started() const;        ///< Whether there was a sample with all velocities.
  double silent_s() const;     ///< Since a velocity other than the yaw rate was measured.
  double velocity(std::size_t state) const;  ///< Over ground, in the log's unit.
  double covariance(std::size_t row, std::size_t column) const;  ///< Of two velocities.
  double deviation(std::size_t state) const;    ///< Standard deviation of a velocity.
  double disturbance(std::size_t state) const;  ///< d, in the target's unit.
  double heading() const;                       ///< rad; 0 where planar is off.
  std::array<double, 2> current() const;        ///< c [m/s], as Drift has its axes.
  Drift drift() const;                          ///< Zero while velocities are measured.
  /// By how much the variance of the model's errors is taken larger than they were one step ahead.
  double noise_factor() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace kelpie
