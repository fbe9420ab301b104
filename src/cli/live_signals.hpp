// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <csignal>
#include <optional>

#include "live/requests.hpp"

namespace kelpie::cli {

/// During its lifetime, SIGHUP asks to reload the configuration, SIGUSR1 to freeze learning and
/// SIGUSR2 to resume learning. At most one instance at a time.
class LiveSignals {
 public:
  LiveSignals();
  ~LiveSignals();
  LiveSignals(const LiveSignals&) = delete;
  LiveSignals& operator=(const LiveSignals&) = delete;

  static bool asked_to_reload();  ///< Since the last call.
  static std::optional<live::Request>
  asked_for();  ///< Since the last call; the later of two requests.

 private:
  static constexpr std::array<int, 3> kSignals{SIGHUP, SIGUSR1, SIGUSR2};
  std::array<void (*)(int), kSignals.size()> previous_{};
};

}  // namespace kelpie::cli
