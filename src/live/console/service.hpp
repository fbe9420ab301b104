// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace kelpie::cli {

/// Notifications to systemd. Does nothing unless started by systemd and built with libsystemd.
class Service {
 public:
  Service();

  void ready();      ///< The service works.
  void reloading();  ///< Reload of the configuration begins; ready() ends the reload.
  void stopping();   ///< The service ends.
  /// Watchdog signal, sent only when due; cheap otherwise.
  void alive();

 private:
  std::chrono::microseconds every_{0};  // 0: nobody watches
  std::chrono::steady_clock::time_point said_;
};

}  // namespace kelpie::cli
