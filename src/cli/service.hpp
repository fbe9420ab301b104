// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace kelpie::cli {

/// What systemd is told of a service. Does nothing where none has started this program, or it was
/// built without libsystemd.
class Service {
 public:
  Service();

  void ready();      ///< It does its work.
  void reloading();  ///< It reads its configuration anew; ready() says that it has.
  void stopping();   ///< It is about to end.
  /// That it is alive, as often as the watchdog wants to hear it. Cheap where it isn't yet time.
  void alive();

 private:
  std::chrono::microseconds every_{0};  // 0: nobody watches
  std::chrono::steady_clock::time_point said_;
};

}  // namespace kelpie::cli
