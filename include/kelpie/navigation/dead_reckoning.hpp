// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "kelpie/model/open_loop.hpp"
#include "kelpie/model/rollout.hpp"

namespace kelpie {

/// Settings of a DeadReckoning.
struct DeadReckoningSettings {
  double step_s = 0.25;  ///< s, longest step of the integrator
  CommandPath between = CommandPath::linear;
  /// The first three states are surge, sway [m/s] and yaw rate [rad/s]: estimates position, heading
  /// and current too. Refused where a name says otherwise (OpenLoop::axes).
  bool planar = true;
  /// Standard deviation of the current [m/s] at the start; 0: no current.
  double current_m_s = 0.1;
  /// Random walk of the current [m/s/√s].
  double current_wander = 0.001;
  /// Duration of simulated outages [s] while velocities are measured; 0: none.
  double practice_s = 20.0;
  /// Velocities measured by a gyro of their own, apart from the velocity log; in planar motion the
  /// yaw rate (2) always is. Empty: roll, pitch and yaw rate by name, beside other velocities.
  std::vector<std::size_t> rates{};
  /// Whether repeated values and exact zeros are recognised (VelocityFault).
  bool checks = true;

  void validate(std::size_t states) const;  ///< Throws InputError naming the field.
};

/// Why a velocity of the last sample doesn't count as measured.
enum class VelocityFault : std::uint8_t {
  none,         ///< measured
  missing,      ///< NaN: no message, or a message that calls itself invalid
  repeated,     ///< all values equal the last ones to the last bit: no new measurement
  zero,         ///< all values are exactly 0, while the vehicle moves or its commands would move it
  frozen,       ///< constant to the last bit for too long, while the vehicle moves
  implausible,  ///< beyond three standard deviations: moves the estimate little
};

inline constexpr std::size_t kVelocityFaults = 6;  ///< number of VelocityFault values

/// "zero", "frozen", …
std::string_view fault_name(VelocityFault fault);

/// The way of the vehicle since the start of an outage, in the frame of heading() = 0.
struct Drift {
  std::array<double, 2> position_m{};     ///< along surge and sway at heading 0
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
/// In an outage d fades and c stays. The next measurement is weighted by both covariances. No
/// measurement moves a velocity by more than three of its standard deviations (deviation(), before
/// the measurement), so that neither an outlier nor a long outage makes the estimate jump. After
/// three measurements of a velocity in succession beyond three standard deviations that agree with
/// one another, its standard deviations grow to the error found, and the fourth measurement is
/// blended in.
///
/// Recognised without a message's own word (`checks`): values that repeat the last ones to the last
/// bit are no new measurement, as of a sensor whose driver holds values. Exact zeros of all
/// velocities but the yaw rate are a fault at once where the estimate is beyond three standard
/// deviations from 0, or the equations of motion at rest expect an acceleration beyond three of
/// their errors. Constant values that aren't 0 within the noise are frozen after 0.5 s, or three
/// times the usual time between new values. A vehicle at rest with exactly constant values (a
/// simulator, a coarse resolution) counts as not measured for 3 s, and as measured from then on,
/// until the commands would move it.
///
/// Calibration: while velocities are measured, outages are simulated in parallel, and the process
/// noise is set so that the predicted covariance matches the errors at the end of the outages
/// (noise_factor()); the ellipse of drift() and the covariance of velocities are widened by age as
/// practised outages ask. Four filters run: without a current, with a constant current, with a
/// random walk, and with a random walk and an earlier model (use()). From the fifth outage on, the
/// filter with the least error is used; a richer hypothesis needs less than 0.7 of the error of a
/// simpler hypothesis.
///
/// Velocities stay within the range seen in learning and in measurements, widened by half its
/// width.
/// Cost: 4 + 2 · states accelerations per step and filter, twice with simulated outages. Allocates
/// in the constructor and in copies only. One thread at a time.
class DeadReckoning {
 public:
  /// Throws InputError on settings that don't validate, on more than six states, and (planar) where
  /// the names of the first three velocities aren't those of surge, sway and yaw rate.
  explicit DeadReckoning(const OpenLoop& model, const DeadReckoningSettings& settings = {});
  ~DeadReckoning();
  DeadReckoning(const DeadReckoning& other);                 ///< With a model of its own.
  DeadReckoning(DeadReckoning&& other) noexcept;             ///< `other` is empty then.
  DeadReckoning& operator=(const DeadReckoning& other);      ///< As the copy.
  DeadReckoning& operator=(DeadReckoning&& other) noexcept;  ///< As above.

  /// Advances to the time t [s] and the inputs x of the model; NaN: velocity not measured. A
  /// command that isn't finite keeps its previous value. Velocities may come in samples of their
  /// own, as from a velocity log and a gyro. `covariance` of the measured velocities, row-major
  /// over all states; default: the noise known to the model. Starts once every velocity was
  /// measured within a second. Where time doesn't advance, only the measurement counts. Throws
  /// InputError on spans of another size, a time that isn't finite, and a step of more than
  /// Rollout::kMostSteps steps; the state is unchanged then.
  void update(std::span<const double> x, double t, std::span<const double> covariance = {});

  /// Adds a measured heading [rad] with its standard deviation, with the sign of the yaw rate.
  /// Without a measured heading, heading() starts at 0; the first heading is taken as it is, and
  /// current and position turn with it. Throws InputError with planar off, on
  /// numbers that aren't finite, and on a deviation <= 0.
  void measured_heading(double heading, double deviation);

  /// Goes on with another model of the same inputs and velocities, such as a later state of a
  /// learner: estimate, practice and current stay. A model learned in a current takes the current
  /// for dynamics, so one filter stays with an earlier model until a later model's error in
  /// practice is below 0.7 of the earlier model's. Allocates. Throws InputError on other inputs or
  /// velocities.
  void use(const OpenLoop& model);

  /// After use(), where the model has its commands in other units, as behind other actuators: the
  /// last sample had the commands of `x` (NaN: unknown; velocities are not looked at), which go on
  /// as `between` says. Without this call the next step would go from one unit to the other. Throws
  /// InputError on another number of inputs. Allocates nothing.
  void restate(std::span<const double> x, CommandPath between);

  std::size_t states() const;  ///< Number of velocities.
  bool started() const;        ///< After the first samples with all velocities.
  double silent_s() const;     ///< Time since the velocity log measured a velocity.
  VelocityFault fault(std::size_t state) const;  ///< Of the last sample.
  /// Largest change of a velocity by the last sample's measurement, in standard deviations before.
  double step() const;
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
