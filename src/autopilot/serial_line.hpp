// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <termios.h>

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "autopilot/byte_line.hpp"
#include "file/descriptor.hpp"

namespace kelpie::autopilot {

bool is_baud_rate(unsigned bits_per_s);
std::string baud_rates_text();  ///< All valid rates.

/// A serial line, 8N1. An unplugged line is opened again once plugged in.
class SerialLine final : public ByteLine {
 public:
  explicit SerialLine(const Connection& connection);

  std::span<const std::byte> read(std::chrono::milliseconds timeout) override;
  void write(std::span<const std::byte> bytes) override;
  std::string fault() const override;

 private:
  using Clock = std::chrono::steady_clock;

  std::string open();  // the error, or ""
  void lose();

  Connection connection_;
  std::unique_ptr<file::Descriptor> line_;  // null: unplugged
  Clock::time_point tried_;
  std::vector<std::byte> buffer_;
};

}  // namespace kelpie::autopilot
