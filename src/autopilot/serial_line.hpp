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
std::string baud_rates_text();  ///< All that there are.

/// A serial line, 8N1. Where it is unplugged it is opened again once it is back.
class SerialLine final : public ByteLine {
 public:
  explicit SerialLine(const Connection& connection);

  std::span<const std::byte> read(std::chrono::milliseconds most) override;
  void write(std::span<const std::byte> bytes) override;
  std::string fault() const override;

 private:
  using Clock = std::chrono::steady_clock;

  std::string open();  // why it failed, or ""
  void lose();

  Connection connection_;
  std::unique_ptr<file::Descriptor> line_;  // null: unplugged
  Clock::time_point tried_;
  std::vector<std::byte> buffer_;
};

}  // namespace kelpie::autopilot
