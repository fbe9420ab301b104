// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kelpie/model/open_loop.hpp"

namespace kelpie {

/// Interpolation between samples of inputs that are not integrated.
enum class CommandPath : std::uint8_t {
  held,    ///< constant, then a step: commands
  linear,  ///< a straight line: measurements
};

/// Settings of a Rollout.
struct RolloutSettings {
  double step_s = 0.25;  ///< s, longest step of the integrator
  CommandPath between = CommandPath::linear;
  std::vector<std::size_t> measured{};  ///< measured states (0: the first state)

  void validate(std::size_t states) const;  ///< Throws InputError naming the field.
};

/// Integrates learned accelerations from a start under commands, by the classical Runge-Kutta
/// method of fourth order: predicted velocities of the vehicle without measurements.
///
/// An attitude is integrated from the angular velocities of the model (OpenLoop::attitude); without
/// them, and where one of them is measured, the attitude comes with the samples, as the commands.
///
/// A velocity is the velocity at the start and the share of the predicted change that practice
/// found best (OpenLoop::kept). Spread: from the noise of the first measurement to the errors in
/// practice (OpenLoop::off), linear in time up to the first age, then along lines of the logarithms
/// of age and error; beyond the last age the error grows on as between the last two, with the
/// square root of time at most. No spread is larger than the range seen. Bounded: a velocity leaves
/// the range seen by half the width of the range at most. A number that isn't finite makes
/// dependent velocities NaN until the next start(), and beyond() true. Allocates in the constructor
/// only. One thread at a time.
class Rollout {
 public:
  /// Throws InputError on settings that don't validate.
  explicit Rollout(OpenLoop model, RolloutSettings settings = {});

  /// Largest number of integrator steps in one advance().
  static constexpr double kMostSteps = 1e6;

  /// Starts at a sample: velocities and present commands. Throws InputError on another number of
  /// inputs than the model has.
  void start(std::span<const double> x);

  /// Advances by dt_s > 0 to the commands of x. Measured velocities are copied from x, other
  /// velocities in x are ignored. Where time steps back, only the commands change. Throws
  /// InputError on another number of inputs, and on a dt_s that isn't finite or takes more than
  /// kMostSteps; the state is unchanged then.
  void advance(std::span<const double> x, double dt_s);

  double age_s() const { return age_s_; }
  /// The present inputs of the model: integrated velocities and angles, all others as given. A
  /// velocity here has the whole predicted change, whatever the share that practice keeps.
  std::span<const double> inputs() const { return x_; }
  /// Places of the integrated inputs: the velocities, then the angles.
  std::span<const std::size_t> integrated() const { return integrated_; }
  /// A velocity in the log's unit.
  double velocity(std::size_t state) const;
  /// Standard deviation of a velocity.
  double spread(std::size_t state) const;
  /// Whether an input is outside of the range seen in learning, widened by a twentieth.
  bool beyond() const;

 private:
  static constexpr std::size_t kMostStates = 6;
  // Of the velocities, then of the attitude; unused: 0.
  using Vector = std::array<double, kMostStates + AttitudeMotion::kMostInputs>;

  void place(double share);
  Vector rate(const Vector& values, double share);
  void integrate(double from, double to, double step_s);

  OpenLoop model_;
  RolloutSettings settings_;
  std::vector<std::size_t> integrated_;  ///< inputs: the velocities, then the attitude
  std::vector<bool> measured_;           ///< of these
  std::vector<double> x_;                ///< the present inputs
  std::vector<double> from_;             ///< the sample before
  std::vector<double> to_;               ///< the sample after
  std::vector<double> at_;               ///< scratch: inputs of one evaluation
  Vector start_{};                       ///< velocities at the start
  double age_s_ = 0.0;
};

}  // namespace kelpie
