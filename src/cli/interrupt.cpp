// SPDX-License-Identifier: Apache-2.0
#include "cli/interrupt.hpp"

#include <atomic>
#include <csignal>

namespace kelpie::cli {
namespace {

std::atomic<bool> asked_to_stop{false};  // NOLINT: a signal handler has nothing else to reach
static_assert(std::atomic<bool>::is_always_lock_free);

}  // namespace

InterruptGuard::InterruptGuard() {
  asked_to_stop = false;
  previous_ = std::signal(SIGINT, [](int) {
    asked_to_stop = true;
    static_cast<void>(std::signal(SIGINT, SIG_DFL));
  });
}

InterruptGuard::~InterruptGuard() {
  static_cast<void>(std::signal(SIGINT, previous_));
}

bool InterruptGuard::asked() {
  return asked_to_stop;
}

}  // namespace kelpie::cli
