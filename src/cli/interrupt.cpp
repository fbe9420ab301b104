// SPDX-License-Identifier: Apache-2.0
#include "cli/interrupt.hpp"

#include <atomic>
#include <cstddef>

namespace kelpie::cli {
namespace {

std::atomic<bool> asked_to_stop{false};  // NOLINT: a signal handler has nothing else to reach
static_assert(std::atomic<bool>::is_always_lock_free);

}  // namespace

InterruptGuard::InterruptGuard() {
  asked_to_stop = false;
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    previous_[i] = std::signal(kSignals[i], [](int) {
      asked_to_stop = true;
      for (const int number : kSignals) {
        static_cast<void>(std::signal(number, SIG_DFL));
      }
    });
  }
}

InterruptGuard::~InterruptGuard() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    static_cast<void>(std::signal(kSignals[i], previous_[i]));
  }
}

bool InterruptGuard::asked() {
  return asked_to_stop;
}

}  // namespace kelpie::cli
