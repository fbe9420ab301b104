// SPDX-License-Identifier: Apache-2.0
#include "mavlink/frame_parser.hpp"

#include <algorithm>

#include "mavlink/checksum.hpp"

namespace kelpie::mavlink {
namespace {

constexpr auto kMagic1 = std::byte{0xFE};
constexpr auto kMagic2 = std::byte{0xFD};
constexpr std::size_t kHead1 = 6;
constexpr std::size_t kHead2 = 10;
constexpr std::size_t kChecksum = 2;
constexpr std::size_t kSignature = 13;
constexpr unsigned kSignedFlag = 1;
// A sequence number has a byte: what is further ahead came late, twice, or after a start anew.
constexpr int kMostMissing = 128;

std::uint8_t byte_at(std::span<const std::byte> bytes, std::size_t at) {
  return static_cast<std::uint8_t>(bytes[at]);
}

bool is_magic(std::byte byte) {
  return byte == kMagic1 || byte == kMagic2;
}

}  // namespace

// What stands before the payload. Both versions end with system, component and number of message.
struct FrameParser::Head {
  std::span<const std::byte> bytes;  // from the magic on
  bool second = bytes.front() == kMagic2;
  std::size_t size = second ? kHead2 : kHead1;

  bool whole() const { return bytes.size() >= size; }
  std::size_t payload_bytes() const { return byte_at(bytes, 1); }
  unsigned must_understand() const { return second ? byte_at(bytes, 2) : 0U; }
  bool is_signed() const { return (must_understand() & kSignedFlag) != 0; }
  std::size_t frame_bytes() const {
    return size + payload_bytes() + kChecksum + (is_signed() ? kSignature : 0);
  }
  std::uint8_t sequence() const { return byte_at(bytes, second ? 4 : 2); }
  std::uint8_t system() const { return byte_at(bytes, second ? 5 : 3); }
  std::uint8_t component() const { return byte_at(bytes, second ? 6 : 4); }
  std::uint32_t id() const {
    return second ? byte_at(bytes, 7) | static_cast<std::uint32_t>(byte_at(bytes, 8)) << 8U |
                        static_cast<std::uint32_t>(byte_at(bytes, 9)) << 16U
                  : byte_at(bytes, 5);
  }
  std::span<const std::byte> payload() const { return bytes.subspan(size, payload_bytes()); }

  bool has_right_checksum(std::uint8_t crc_extra) const {
    const std::size_t end = size + payload_bytes();
    const auto extra = static_cast<std::byte>(crc_extra);
    const std::uint16_t crc = checksum(std::span(&extra, 1), checksum(bytes.subspan(1, end - 1)));
    return crc == (byte_at(bytes, end) | byte_at(bytes, end + 1) << 8U);
  }
};

void FrameParser::add(std::span<const std::byte> bytes) {
  bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(at_));
  at_ = 0;
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
}

bool FrameParser::next(Frame& frame) {
  frame.definition = nullptr;
  while (at_ < bytes_.size()) {
    if (!is_magic(bytes_[at_])) {
      const auto from = bytes_.begin() + static_cast<std::ptrdiff_t>(at_);
      const auto skipped =
          static_cast<std::size_t>(std::find_if(from, bytes_.end(), is_magic) - from);
      counts_.skipped_bytes += skipped;
      at_ += skipped;
      continue;
    }
    const Head head{.bytes = std::span<const std::byte>(bytes_).subspan(at_)};
    if (!head.whole() || head.bytes.size() < head.frame_bytes()) {
      return false;
    }
    at_ += accept(head, frame);
    if (frame.definition != nullptr) {
      return true;
    }
  }
  return false;
}

// How many bytes to go on by; a frame has its definition.
std::size_t FrameParser::accept(const Head& head, Frame& frame) {
  const Definition* const definition = find_definition(head.id());
  const std::size_t end = head.frame_bytes();
  if (definition == nullptr || (head.must_understand() & ~kSignedFlag) != 0) {
    // Taken for a frame where another one follows, or nothing yet; else it was another byte that
    // happened to be the magic one.
    if (head.bytes.size() > end && !is_magic(head.bytes[end])) {
      ++counts_.skipped_bytes;
      return 1;
    }
    ++counts_.unknown;
    count_lost(head);
    return end;
  }
  if (head.payload_bytes() > definition->all_bytes ||
      (!head.second && head.payload_bytes() < definition->basic_bytes) ||
      !head.has_right_checksum(definition->crc_extra)) {
    ++counts_.bad_checksum;
    return 1;  // the next frame may begin anywhere
  }
  count_lost(head);
  ++counts_.frames;
  frame = {.definition = definition,
           .system = head.system(),
           .component = head.component(),
           .sequence = head.sequence(),
           .version = head.second ? 2 : 1,
           .is_signed = head.is_signed(),
           .payload = head.payload()};
  return end;
}

void FrameParser::count_lost(const Head& head) {
  const auto [last, first_time] =
      sequences_.try_emplace({head.system(), head.component()}, head.sequence());
  if (!first_time) {
    const int missing = static_cast<std::uint8_t>(head.sequence() - last->second - 1);
    counts_.lost += missing < kMostMissing ? static_cast<std::uint64_t>(missing) : 0U;
    last->second = head.sequence();
  }
}

}  // namespace kelpie::mavlink
