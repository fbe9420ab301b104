// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "mavlink/definition.hpp"

namespace kelpie::mavlink {

/// Writes MAVLink 2 frames of a sender, without trailing zeros.
class FrameWriter {
 public:
  /// Appends a signature of 13 bytes to a frame.
  using Signer = std::function<void(std::vector<std::byte>& frame)>;

  /// 1 … 255 each; 191 is MAV_COMP_ID_ONBOARD_COMPUTER. Without a signer frames are unsigned.
  explicit FrameWriter(std::uint8_t system, std::uint8_t component = 191, Signer signer = {})
      : system_(system), component_(component), signer_(std::move(signer)) {}

  /// Begins a message of zeros by name ("STATUSTEXT"). Throws InputError (name) on an unknown name.
  FrameWriter& begin(std::string_view name);
  /// Requires begin(). Throws InputError (name) on an unknown or non-numeric field, a `value`
  /// outside of the integer's range, and an index beyond the field's elements.
  FrameWriter& set(std::string_view name, double value, std::size_t index = 0);
  /// A longer text is cut off. Throws InputError (name) as above.
  FrameWriter& set(std::string_view name, std::string_view text);
  /// The frame, with the next sequence number; valid until the next call.
  std::span<const std::byte> finish();

 private:
  std::uint8_t system_;
  std::uint8_t component_;
  Signer signer_;
  std::uint8_t sequence_ = 0;
  const Definition* definition_ = nullptr;
  std::vector<std::byte> payload_;
  std::vector<std::byte> frame_;
};

}  // namespace kelpie::mavlink
