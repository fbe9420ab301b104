// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bag/autopilot_state.hpp"
#include "log/ardusub.hpp"

namespace kelpie::autopilot {

/// Asks an autopilot for the parameters that tell which outputs drive motors, and their directions:
/// SERVOn_FUNCTION, then MOT_n_DIRECTION, and FRAME_CONFIG. Without a line or a clock of its own.
class ParameterKeeper {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// `outputs` by their numbers; none: nothing is asked for.
  explicit ParameterKeeper(std::vector<std::size_t> outputs) : outputs_(std::move(outputs)) {}

  /// Takes the vehicle's PARAM_VALUE.
  void hear(const std::string& name, double value) { bag::keep_parameter(known_, name, value); }

  /// The parameter to ask for now, if any: one at a time, each again after
  /// Tuning::between_parameters, at most Tuning::most_asked times.
  std::optional<std::string> next_request(Time now);

  /// Parameters that did not come, a sentence; or none.
  std::vector<std::string> faults() const;

 private:
  std::vector<std::string> missing() const;

  std::vector<std::size_t> outputs_;
  log::ParameterMap known_;
  std::map<std::string, int> asked_;  // how often
  std::optional<Time> last_;
  std::string waiting_;  // for the answer to
};

}  // namespace kelpie::autopilot
