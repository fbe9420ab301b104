// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <span>
#include <string>

#include "autopilot/link_settings.hpp"

namespace kelpie::autopilot {

/// Bytes from and to an autopilot. For one thread.
class ByteLine {
 public:
  ByteLine() = default;
  virtual ~ByteLine() = default;
  ByteLine(const ByteLine&) = delete;
  ByteLine& operator=(const ByteLine&) = delete;

  /// Received bytes, after a wait of at most `timeout`; valid until the next call.
  virtual std::span<const std::byte> read(std::chrono::milliseconds timeout) = 0;

  /// Never waits: bytes that the line refuses now are lost.
  virtual void write(std::span<const std::byte> bytes) = 0;

  /// Directs write() to the sender of the bytes read last, where several senders are possible.
  virtual void answer_last() {}

  /// Why nothing can be received now; empty: no fault.
  virtual std::string fault() const { return {}; }
};

/// Opens a connection. Throws InputError on an unknown host, a port in use, a missing device or
/// missing permission.
std::unique_ptr<ByteLine> open_line(const Connection& connection);

}  // namespace kelpie::autopilot
