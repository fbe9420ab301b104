// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kelpie/model/open_loop.hpp"

namespace kelpie {

/// How the inputs that aren't integrated go from one sample to the next.
enum class CommandPath : std::uint8_t {
  held,    ///< they stay, and jump: commands
  linear,  ///< along a line: what was measured
};

/// What a Rollout is told.
struct RolloutSettings {
  double step_s = 0.25;  ///< the longest step of the integrator
  CommandPath between = CommandPath::linear;
  std::vector<std::size_t> measured{};  ///< states that are still measured (0: the first state)

  void validate(std::size_t states) const;  ///< Throws InputError naming the field.
};

/// Integrates learned accelerations from a start under commands, by the classical Runge-Kutta
/// method of fourth order: where the vehicle's velocity will be, or is while nothing measures it.
///
/// Spread: a standard deviation that grows from the noise of the first measurement, that of a
/// first-order Gauss-Markov error of each
/// acceleration (OpenLoop::error) carried along by the linearised model.
/// Bounded: a velocity never leaves the range seen by more than half its width, whatever the model.
/// A number that isn't finite makes the velocities that follow from it NaN until the next start(),
/// and beyond() true. Allocates in the constructor only. One thread at a time.
class Rollout {
 public:
  /// Throws InputError on settings that don't validate.
  explicit Rollout(OpenLoop model, RolloutSettings settings = {});

  /// The most steps of the integrator in one advance().
  static constexpr double kMostSteps = 1e6;

  /// Begins at a sample: the velocities, and the commands in force. Throws InputError on another
  /// number of inputs than the model has.
  void start(std::span<const double> x);

  /// Goes on by dt_s > 0, to where the commands are those of x. Of the velocities in x, the
  /// measured ones are taken over; the others aren't looked at. Where time steps back, nothing
  /// passes but the commands. Throws InputError on another number of inputs, and on a dt_s that
  /// isn't finite or takes more than kMostSteps; then nothing has changed.
  void advance(std::span<const double> x, double dt_s);

  double age_s() const { return age_s_; }
  /// In the log's unit.
  double velocity(std::size_t state) const { return x_[model_.states[state]]; }
  /// Standard deviation of the velocity.
  double spread(std::size_t state) const;
  /// Whether some input isn't within the range seen in learning, widened by a twentieth.
  bool beyond() const;

 private:
  static constexpr std::size_t kMostStates = 6;
  using Vector = std::array<double, kMostStates>;                // of states that aren't there: 0
  using Square = std::array<double, kMostStates * kMostStates>;  // column-major

  static std::size_t diagonal(std::size_t state) { return state * (kMostStates + 1); }

  void place(double share);
  Vector rate(const Vector& velocity, double share, double age_s);
  void integrate(double from, double to, double step_s);
  Square slope(const Vector& velocity, double share);
  void carry_spread(const Square& slope, double step_s);
  bool integrated(std::size_t state) const { return !measured_[state]; }

  OpenLoop model_;
  RolloutSettings settings_;
  std::vector<bool> measured_;
  std::vector<double> x_;     ///< where it is
  std::vector<double> from_;  ///< the sample before
  std::vector<double> to_;    ///< the sample that is gone to
  std::vector<double> at_;    ///< scratch: inputs of one evaluation
  Square velocity_spread_{};  ///< covariance of the velocities,
  Square cross_spread_{};     ///< of velocities and errors,
  Vector error_spread_{};     ///< of the errors, taken as independent
  double age_s_ = 0.0;
};

}  // namespace kelpie
