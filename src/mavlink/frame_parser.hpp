// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "mavlink/frame.hpp"

namespace kelpie::mavlink {

/// Finds MAVLink 1 and 2 frames in bytes from a serial line, datagrams or a file, whatever lies
/// between them. Messages that aren't among definitions(), or are
/// by another definition, are passed over. Keeps at most one frame's bytes besides what is added.
class FrameParser {
 public:
  /// What came, since the beginning.
  struct Counts {
    std::uint64_t frames = 0;         ///< given
    std::uint64_t unknown = 0;        ///< frames of no definition that is here
    std::uint64_t bad_checksum = 0;   ///< what looked like a frame and wasn't whole
    std::uint64_t skipped_bytes = 0;  ///< outside of frames
    std::uint64_t lost = 0;           ///< messages missing between sequence numbers, all systems
  };

  /// Adds what was read.
  void add(std::span<const std::byte> bytes);

  /// The next frame, whose payload is valid until bytes are added; false where more bytes are
  /// needed.
  bool next(Frame& frame);

  const Counts& counts() const { return counts_; }

 private:
  std::size_t accept(std::span<const std::byte> bytes, const FrameHead& head, Frame& frame);
  void count_lost(const FrameHead& head);

  std::vector<std::byte> bytes_;
  std::size_t at_ = 0;
  /// The last sequence number of a system's component.
  std::map<std::pair<std::uint8_t, std::uint8_t>, std::uint8_t> sequences_;
  Counts counts_;
};

}  // namespace kelpie::mavlink
