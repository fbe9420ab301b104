// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <span>
#include <string>

#include "autopilot/link_settings.hpp"

namespace kelpie::autopilot {

/// Bytes from and to an autopilot. Used by one thread.
class ByteLine {
 public:
  ByteLine() = default;
  virtual ~ByteLine() = default;
  ByteLine(const ByteLine&) = delete;
  ByteLine& operator=(const ByteLine&) = delete;

  /// What has come, for which it waits at most so long; valid until the next call.
  virtual std::span<const std::byte> read(std::chrono::milliseconds most) = 0;

  /// Never waits: what the line doesn't take now is lost.
  virtual void write(std::span<const std::byte> bytes) = 0;

  /// Who sent what was read last is whom write() answers, where there are several.
  virtual void answer_last() {}

  /// Why nothing can come now; empty: it can.
  virtual std::string fault() const { return {}; }
};

/// Opens it. Throws InputError where there is no such host, where the port is taken, where there is
/// no such device or no permission for it.
std::unique_ptr<ByteLine> open_line(const Connection& connection);

}  // namespace kelpie::autopilot
