// SPDX-License-Identifier: Apache-2.0
#include "mavlink/frame_parser.hpp"

#include <algorithm>

namespace kelpie::mavlink {
namespace {

// A sequence number has a byte: what is further ahead came late, twice, or after a start anew.
constexpr int kMostMissing = 128;
constexpr std::size_t kPassed = static_cast<std::size_t>(-1);

}  // namespace

void FrameParser::add(std::span<const std::byte> bytes) {
  due_ = at_ == bytes_.size() ? 0 : due_ < at_ ? kPassed : due_ - at_;
  bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(at_));
  checksum_.drop(at_);
  at_ = 0;
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  checksum_.add(bytes);
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
    const auto bytes = std::span<const std::byte>(bytes_).subspan(at_);
    const FrameHead head(bytes);
    if (!head.is_whole()) {
      return false;
    }
    at_ += accept(bytes, head, frame);
    if (frame.definition != nullptr) {
      return true;
    }
  }
  return false;
}

// How many bytes to go on by; a frame has its definition.
std::size_t FrameParser::accept(std::span<const std::byte> bytes, const FrameHead& head,
                                Frame& frame) {
  const std::size_t end = head.frame_bytes();
  const bool is_due = at_ == due_;
  due_ = is_due ? at_ + end : due_;
  switch (read_frame(head, checksum_.of(at_ + 1, head.checked().size()), frame)) {
    case FrameState::damaged:
      ++counts_.bad_checksum;
      return 1;  // the next frame may begin anywhere
    case FrameState::unknown:
      // It was another byte that happened to be the magic one, where no frame is due or follows.
      if (!is_due || (bytes.size() > end && !is_magic(bytes[end]))) {
        ++counts_.skipped_bytes;
        return 1;
      }
      ++counts_.unknown;
      break;
    case FrameState::sound:
      ++counts_.frames;
      due_ = at_ + end;
  }
  count_lost(head);
  return end;
}

void FrameParser::count_lost(const FrameHead& head) {
  const auto [last, first_time] =
      sequences_.try_emplace({head.system(), head.component()}, head.sequence());
  if (!first_time) {
    const int missing = static_cast<std::uint8_t>(head.sequence() - last->second - 1);
    counts_.lost += missing < kMostMissing ? static_cast<std::uint64_t>(missing) : 0U;
    last->second = head.sequence();
  }
}

}  // namespace kelpie::mavlink
