// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <csignal>
#include <initializer_list>
#include <optional>
#include <utility>
#include <vector>

namespace kelpie::cli {

/// One handler for some signals; the destructor restores the earlier handlers.
class SignalHandlers {
 public:
  SignalHandlers(std::initializer_list<int> signals, void (*handler)(int));
  ~SignalHandlers();
  SignalHandlers(const SignalHandlers&) = delete;
  SignalHandlers& operator=(const SignalHandlers&) = delete;

 private:
  std::vector<std::pair<int, void (*)(int)>> previous_;
};

/// During its lifetime, Ctrl-C or SIGTERM (of `kill` or a service manager) asks the work to stop; a
/// second signal ends the program. At most one instance at a time.
class InterruptGuard {
 public:
  InterruptGuard();

  static bool asked();  ///< Safe from any thread.

 private:
  std::optional<SignalHandlers> handlers_;
};

}  // namespace kelpie::cli
