// SPDX-License-Identifier: Apache-2.0
#include "console/service.hpp"

#include <cstdint>
#include <string>

#ifdef KELPIE_HAVE_SYSTEMD
#include <systemd/sd-daemon.h>
#include <ctime>
#endif

namespace kelpie::cli {
namespace {

void tell(const std::string& state) {
#ifdef KELPIE_HAVE_SYSTEMD
  static_cast<void>(::sd_notify(0, state.c_str()));  // nobody listens: nobody needs to know
#else
  static_cast<void>(state);
#endif
}

}  // namespace

Service::Service() {
#ifdef KELPIE_HAVE_SYSTEMD
  std::uint64_t most_us = 0;
  if (::sd_watchdog_enabled(0, &most_us) > 0) {
    every_ = std::chrono::microseconds(most_us / 3);
  }
#endif
}

// NOLINTBEGIN(readability-convert-member-functions-to-static): told by a service
void Service::ready() {
  tell("READY=1");
}

void Service::reloading() {
#ifdef KELPIE_HAVE_SYSTEMD
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);  // as the protocol asks for
  tell("RELOADING=1\nMONOTONIC_USEC=" +
       std::to_string(std::int64_t{now.tv_sec} * 1'000'000 + now.tv_nsec / 1000));
#endif
}

void Service::stopping() {
  tell("STOPPING=1");
}
// NOLINTEND(readability-convert-member-functions-to-static)

void Service::alive() {
  const auto now = std::chrono::steady_clock::now();
  if (every_.count() > 0 && now - said_ >= every_) {
    said_ = now;
    tell("WATCHDOG=1");
  }
}

}  // namespace kelpie::cli
