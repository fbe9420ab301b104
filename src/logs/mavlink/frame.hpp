// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "mavlink/definition.hpp"

namespace kelpie::mavlink {

/// A message with a right checksum.
struct Frame {
  const Definition* definition = nullptr;
  std::uint8_t system = 0;               ///< the vehicle
  std::uint8_t component = 0;            ///< part of the vehicle: 1 is the autopilot
  std::uint8_t sequence = 0;             ///< count of the component's messages
  int version = 2;                       ///< of MAVLink
  bool is_signed = false;                ///< the last 13 bytes are a signature, not checked here
  std::span<const std::byte> payload{};  ///< not longer than the definition's
  std::span<const std::byte> bytes{};    ///< the whole frame
};

inline constexpr auto kMagic1 = std::byte{0xFE};
inline constexpr auto kMagic2 = std::byte{0xFD};

inline bool is_magic(std::byte byte) {
  return byte == kMagic1 || byte == kMagic2;
}

/// Head of a frame, in either version of MAVLink. All functions but has_head() and is_whole()
/// require has_head().
class FrameHead {
 public:
  /// Requires a magic byte at the beginning of `bytes`, which may continue behind the frame.
  explicit FrameHead(std::span<const std::byte> bytes)
      : bytes_(bytes), second_(bytes.front() == kMagic2), size_(second_ ? kHead2 : kHead1) {}

  bool has_head() const { return bytes_.size() >= size_; }
  bool is_whole() const { return has_head() && bytes_.size() >= frame_bytes(); }
  std::size_t frame_bytes() const {
    return size_ + payload_bytes() + kChecksum + (is_signed() ? kSignature : 0);
  }
  std::size_t payload_bytes() const { return at(1); }
  bool is_second() const { return second_; }  ///< of the version
  bool is_signed() const { return second_ && (at(2) & kSignedFlag) != 0; }
  bool is_of_later_version() const { return second_ && (at(2) & ~kSignedFlag) != 0; }
  std::uint8_t sequence() const { return at(second_ ? 4 : 2); }
  std::uint8_t system() const { return at(second_ ? 5 : 3); }
  std::uint8_t component() const { return at(second_ ? 6 : 4); }
  std::uint32_t id() const {
    return second_ ? at(7) | static_cast<std::uint32_t>(at(8)) << 8U |
                         static_cast<std::uint32_t>(at(9)) << 16U
                   : at(5);
  }
  std::span<const std::byte> frame() const { return bytes_.first(frame_bytes()); }
  std::span<const std::byte> payload() const { return bytes_.subspan(size_, payload_bytes()); }
  /// The bytes under the checksum, and the stored checksum. Both require the whole frame, as
  /// frame().
  std::span<const std::byte> checked() const {
    return bytes_.subspan(1, size_ + payload_bytes() - 1);
  }
  std::uint16_t stated_checksum() const {
    const std::size_t end = size_ + payload_bytes();
    return static_cast<std::uint16_t>(at(end) | at(end + 1) << 8U);
  }

 private:
  static constexpr std::size_t kHead1 = 6;
  static constexpr std::size_t kHead2 = 10;
  static constexpr std::size_t kChecksum = 2;
  static constexpr std::size_t kSignature = 13;
  static constexpr unsigned kSignedFlag = 1;

  std::uint8_t at(std::size_t index) const { return static_cast<std::uint8_t>(bytes_[index]); }

  std::span<const std::byte> bytes_;
  bool second_;
  std::size_t size_;
};

/// Result of checking a frame.
enum class FrameState : std::uint8_t {
  sound,    ///< the checksum is right
  unknown,  ///< of a message or version without a definition here: the checksum cannot be checked
  damaged,  ///< or of another definition
};

/// Requires head.is_whole(). Fills in `frame` for a sound frame; the payload points into the given
/// bytes. Fields added by a sender's later definition are left out of the payload.
FrameState read_frame(const FrameHead& head, Frame& frame);
/// The same, by the checksum() of head.checked().
FrameState read_frame(const FrameHead& head, std::uint16_t crc, Frame& frame);

}  // namespace kelpie::mavlink
