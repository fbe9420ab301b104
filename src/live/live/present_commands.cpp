// SPDX-License-Identifier: Apache-2.0
#include "live/present_commands.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "live/tuning.hpp"

namespace kelpie::live {
namespace {

constexpr double kNever = -std::numeric_limits<double>::infinity();

}  // namespace

PresentCommands::PresentCommands(std::vector<std::string> inputs, double rate_hz, double gap_s)
    : inputs_(std::move(inputs)),
      step_s_(1.0 / (kTuning.command_steps_per_row * rate_hz)),
      gap_s_(gap_s),
      shifts_s_(inputs_.size()),
      newest_s_(kNever) {}

void PresentCommands::use(const std::shared_ptr<const Alignment>& alignment) {
  if (alignment == alignment_) {
    return;
  }
  alignment_ = alignment;
  newest_s_ = kNever;
  driven_.clear();
  std::ranges::fill(shifts_s_, 0.0);
  for (std::size_t k = 0; k < alignment->commands.size(); ++k) {
    const auto found = std::ranges::find(inputs_, alignment->commands[k]);
    const auto input = static_cast<std::size_t>(found - inputs_.begin());
    shifts_s_[input] = alignment->lag_s;
    if (!alignment->actuators.empty()) {
      const Actuator& actuator = alignment->actuators[k];
      driven_.push_back({input, actuator.takes_time(), ActuatorState(actuator, 1.0 / step_s_)});
    }
  }
}

void PresentCommands::act(std::span<double> x, double t) {
  if (!(std::abs(t - newest_s_) <= gap_s_)) {
    std::ranges::for_each(driven_, [](Driven& command) { command.state.rest(); });
    newest_s_ = kNever;
  }
  const bool steps = t >= newest_s_ + step_s_;
  for (Driven& command : driven_) {
    if (steps || !command.takes_time) {
      command.value = command.state.next(x[command.input], t);
    }
    x[command.input] = command.value;
  }
  newest_s_ = steps ? t : newest_s_;
}

}  // namespace kelpie::live
