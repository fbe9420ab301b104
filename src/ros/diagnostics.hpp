// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "live/configuration.hpp"
#include "live/health.hpp"

namespace kelpie::ros {

/// One part of the program and how it does, as diagnostic_msgs/DiagnosticStatus has it.
struct DiagnosticStatus {
  enum class Level : std::uint8_t { ok = 0, warn = 1, error = 2 };

  Level level = Level::ok;
  std::string name;
  std::string message;  ///< in words
  std::vector<std::pair<std::string, std::string>> values{};
};

/// Of messages, learning, every axis, and what is kept on the disk. `before` is the health of a
/// second ago: what has got worse since then is a warning.
std::vector<DiagnosticStatus> diagnose(const live::Health& now, const live::Health& before,
                                       const live::Configuration& configuration);

}  // namespace kelpie::ros
