// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "live/health_table.hpp"

namespace kelpie::ros {

/// State of one part of the program, as diagnostic_msgs/DiagnosticStatus has it.
struct DiagnosticStatus {
  live::AlertLevel level = live::AlertLevel::ok;
  std::string name;
  std::string message;  ///< the alerts, errors first; without any, what is well
  std::vector<std::pair<std::string, std::string>> values{};
};

/// Statuses of messages, learning, the vehicle, each axis and the disk, by the table of health
/// fields. `before` is the health of a second ago: growth since then can be an alert.
std::vector<DiagnosticStatus> diagnose(const live::Health& now, const live::Health& before);

}  // namespace kelpie::ros
