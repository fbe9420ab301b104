// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/fsuid.h>
#include <unistd.h>

#include <filesystem>

namespace kelpie::testing {

/// While an object lives, the thread and the threads started meanwhile have the permissions of a
/// user without privileges in `folder`: root may write anywhere.
class PlainUser {
 public:
  explicit PlainUser(const std::filesystem::path& folder) {
    if (::geteuid() == 0 && ::chown(folder.c_str(), kNobody, kNobody) == 0) {
      ::setfsuid(kNobody);
    }
  }
  ~PlainUser() { ::setfsuid(::geteuid()); }
  PlainUser(const PlainUser&) = delete;
  PlainUser(PlainUser&&) = delete;
  PlainUser& operator=(const PlainUser&) = delete;
  PlainUser& operator=(PlainUser&&) = delete;

  /// Whether permissions hold: false for root without the right to become another user.
  static bool is_plain() { return ::setfsuid(static_cast<uid_t>(-1)) != 0; }

 private:
  static constexpr uid_t kNobody = 65534;
};

}  // namespace kelpie::testing
