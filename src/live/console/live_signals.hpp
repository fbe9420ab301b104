// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "cli/interrupt.hpp"
#include "live/requests.hpp"

namespace kelpie::cli {

/// Handler of signals during its lifetime: SIGHUP reloads the configuration, SIGUSR1 freezes
/// learning, SIGUSR2 resumes. Requires at most one object at a time.
class LiveSignals {
 public:
  LiveSignals();

  static bool asked_to_reload();                    ///< Since the last call.
  static std::optional<live::Request> asked_for();  ///< The same; of both signals, the last.

 private:
  SignalHandlers handlers_;
};

}  // namespace kelpie::cli
