// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "mavlink/checksum.hpp"
#include "mavlink/frame.hpp"

namespace kelpie::mavlink {

/// Finds MAVLink 1 and 2 frames in a stream of bytes from a serial line, datagrams or a file, with
/// arbitrary bytes between frames. Skips messages outside of definitions(), or with another
/// definition: the first where the last frame ended, any byte may begin the others. Keeps at most
/// the bytes of a frame besides the added bytes. The work is in proportion to the bytes, whatever
/// the bytes are (RunningChecksum).
class FrameParser {
 public:
  /// Counts since the start.
  struct Counts {
    std::uint64_t frames = 0;         ///< given
    std::uint64_t unknown = 0;        ///< without known definition, where a frame is due
    std::uint64_t bad_checksum = 0;   ///< apparent frames, damaged or of another definition
    std::uint64_t skipped_bytes = 0;  ///< outside of frames
    std::uint64_t lost = 0;  ///< messages missing between sequence numbers, over all systems
  };

  /// Appends received bytes.
  void add(std::span<const std::byte> bytes);

  /// Finds the next frame; the payload is valid until the next add(). Returns false if more bytes
  /// are needed.
  bool next(Frame& frame);

  /// Drops the begin of a frame whose rest cannot come, because another sender's bytes follow.
  void drop_rest() { at_ = bytes_.size(); }

  const Counts& counts() const { return counts_; }

 private:
  std::size_t accept(std::span<const std::byte> bytes, const FrameHead& head, Frame& frame);
  void count_lost(const FrameHead& head);

  std::vector<std::byte> bytes_;
  RunningChecksum checksum_;  ///< of bytes_
  std::size_t at_ = 0;
  std::size_t due_ = 0;  ///< where the frame behind the last one begins
  /// The last sequence number of a system's component.
  std::map<std::pair<std::uint8_t, std::uint8_t>, std::uint8_t> sequences_;
  Counts counts_;
};

}  // namespace kelpie::mavlink
