// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "kelpie/alignment/alignment.hpp"

namespace kelpie::live {

/// What actuators make of the newest commands, for a prediction of the present between the rows.
/// The state of each actuator is kept from message to message.
class PresentCommands {
 public:
  /// `rate_hz`: rows per second; `gap_s`: a longer silence ends a stretch.
  PresentCommands(std::vector<std::string> inputs, double rate_hz, double gap_s);

  /// The alignment in use; under another one, actuators begin at rest. Allocates in that case.
  void use(const std::shared_ptr<const Alignment>& alignment);

  /// Lag of each input [s]; 0 of velocities.
  std::span<const double> shifts_s() const { return shifts_s_; }

  /// Puts effects in the places of the commands of `x` at the time `t` [s]. Requires use(). A time
  /// that steps back a little counts as the newest. Allocates nothing.
  void act(std::span<double> x, double t);

 private:
  struct Driven {
    std::size_t input;
    bool takes_time;
    ActuatorState state;
    double value = 0.0;
  };

  std::vector<std::string> inputs_;
  double step_s_;  // the shortest of an actuator
  double gap_s_;
  std::shared_ptr<const Alignment> alignment_;
  std::vector<double> shifts_s_;
  std::vector<Driven> driven_;
  double newest_s_;
};

}  // namespace kelpie::live
