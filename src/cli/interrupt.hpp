// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <csignal>

namespace kelpie::cli {

/// During its lifetime, Ctrl-C or SIGTERM (of `kill` or a service manager) asks the work to stop; a
/// second signal ends the program. At most one instance at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard(InterruptGuard&&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;
  InterruptGuard& operator=(InterruptGuard&&) = delete;

  static bool asked();  ///< Safe from any thread.

 private:
  static constexpr std::array<int, 2> kSignals{SIGINT, SIGTERM};
  std::array<void (*)(int), kSignals.size()> previous_{};
};

}  // namespace kelpie::cli
