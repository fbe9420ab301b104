// SPDX-License-Identifier: Apache-2.0
#include "cli/interrupt.hpp"

#include <atomic>

namespace kelpie::cli {
namespace {

std::atomic<bool> asked_to_stop{false};  // NOLINT: a signal handler has nothing else to reach
static_assert(std::atomic<bool>::is_always_lock_free);

void ask_to_stop(int /*signal*/) {
  asked_to_stop = true;
  static_cast<void>(std::signal(SIGINT, SIG_DFL));
  static_cast<void>(std::signal(SIGTERM, SIG_DFL));
}

}  // namespace

SignalHandlers::SignalHandlers(std::initializer_list<int> signals, void (*handler)(int)) {
  for (const int signal : signals) {
    previous_.emplace_back(signal, std::signal(signal, handler));
  }
}

SignalHandlers::~SignalHandlers() {
  for (const auto& [signal, handler] : previous_) {
    static_cast<void>(std::signal(signal, handler));
  }
}

InterruptGuard::InterruptGuard() {
  asked_to_stop = false;
  handlers_.emplace(std::initializer_list<int>{SIGINT, SIGTERM}, ask_to_stop);
}

bool InterruptGuard::asked() {
  return asked_to_stop;
}

}  // namespace kelpie::cli
