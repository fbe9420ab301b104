// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kelpie::cli {

/// While it lives, Ctrl-C asks the work to stop; a second one ends the program. One at a time.
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
  void (*previous_)(int) = nullptr;
};

}  // namespace kelpie::cli
