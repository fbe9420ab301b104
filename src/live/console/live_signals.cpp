// SPDX-License-Identifier: Apache-2.0
#include "console/live_signals.hpp"

#include <atomic>

namespace kelpie::cli {
namespace {

// A signal handler has nothing else to reach. The last signal of two, or 0.
std::atomic<bool> hung_up{false};  // NOLINT
std::atomic<int> asked{0};         // NOLINT

}  // namespace

LiveSignals::LiveSignals()
    : handlers_({SIGHUP, SIGUSR1, SIGUSR2}, [](int signal) {
        if (signal == SIGHUP) {
          hung_up = true;
        } else {
          asked = signal;
        }
      }) {}

bool LiveSignals::asked_to_reload() {
  return hung_up.exchange(false);
}

std::optional<live::Request> LiveSignals::asked_for() {
  switch (asked.exchange(0)) {
    case SIGUSR1:
      return live::Request::freeze;
    case SIGUSR2:
      return live::Request::resume;
    default:
      return std::nullopt;
  }
}

}  // namespace kelpie::cli
