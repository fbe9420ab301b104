// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <csignal>
#include <optional>

#include "live/requests.hpp"

namespace kelpie::cli {

/// Handler of signals during its lifetime: SIGHUP reloads the configuration, SIGUSR1 freezes
/// learning, SIGUSR2 resumes. Requires at most one object at a time.
class LiveSignals {
 public:
  LiveSignals();
  ~LiveSignals();
  LiveSignals(const LiveSignals&) = delete;
  LiveSignals& operator=(const LiveSignals&) = delete;

  static bool asked_to_reload();                    ///< Since the last call.
  static std::optional<live::Request> asked_for();  ///< The same; of both signals, the last.

 private:
  static constexpr std::array<int, 3> kSignals{SIGHUP, SIGUSR1, SIGUSR2};
  std::array<void (*)(int), kSignals.size()> previous_{};
};

}  // namespace kelpie::cli
