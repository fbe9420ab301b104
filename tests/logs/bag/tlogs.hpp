// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mavlink/frame_writer.hpp"

namespace kelpie::testing {

/// Puts a .tlog file together.
class Tlog {
 public:
  /// A frame, and when it was received.
  Tlog& add(std::uint64_t time_us, std::span<const std::byte> frame) {
    offsets_.push_back(bytes_.size());
    for (int shift = 56; shift >= 0; shift -= 8) {
      bytes_.push_back(static_cast<std::byte>(time_us >> static_cast<unsigned>(shift) & 0xFFU));
    }
    bytes_.insert(bytes_.end(), frame.begin(), frame.end());
    return *this;
  }

  std::vector<std::byte>& bytes() { return bytes_; }
  const std::vector<std::size_t>& offsets() const { return offsets_; }  ///< of the frames' stamps
  std::string text() const {
    return {reinterpret_cast<const char*>(bytes_.data()), bytes_.size()};  // NOLINT: bytes as text
  }

 private:
  std::vector<std::byte> bytes_;
  std::vector<std::size_t> offsets_;
};

/// The HEARTBEAT of an autopilot: ArduPilot on a submarine.
inline std::span<const std::byte> heartbeat_of_vehicle(mavlink::FrameWriter& writer,
                                                       bool is_armed = false) {
  writer.begin("HEARTBEAT").set("type", 12).set("autopilot", 3).set("mavlink_version", 3);
  constexpr double kSafetyArmed = 128.0;  // of base_mode
  writer.set("base_mode", is_armed ? kSafetyArmed : 0.0);
  return writer.finish();
}

inline constexpr std::uint64_t kTlogBeginUs = 1'700'000'000'000'000;

/// `count` ATTITUDEs of system 1 at 50 Hz, roll = 0.01 k, booted 10 s before, with a HEARTBEAT at
/// the beginning.
inline Tlog small_tlog(std::size_t count) {
  mavlink::FrameWriter writer(1, 1);
  Tlog log;
  log.add(kTlogBeginUs, heartbeat_of_vehicle(writer));
  for (std::size_t k = 0; k < count; ++k) {
    const auto time = static_cast<double>(k);
    writer.begin("ATTITUDE").set("time_boot_ms", 10'000.0 + 20.0 * time).set("roll", 0.01 * time);
    log.add(kTlogBeginUs + 20'000 * k + 3'000, writer.finish());
  }
  return log;
}

}  // namespace kelpie::testing
