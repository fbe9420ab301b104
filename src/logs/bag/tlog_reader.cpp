// SPDX-License-Identifier: Apache-2.0
#include "bag/tlog_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "bag/byte_reader.hpp"
#include "bag/file_reader.hpp"
#include "bag/mavlink_messages.hpp"
#include "mavlink/frame.hpp"

namespace kelpie::bag {
namespace {

using mavlink::FrameHead;
using mavlink::FrameState;

constexpr std::size_t kStamp = 8;
constexpr std::uint64_t kLatestUs = static_cast<std::uint64_t>(Message::kLatestNs) / 1'000;

std::uint64_t stamp_at(std::span<const std::byte> bytes) {
  return number_at<std::uint64_t>(bytes, std::endian::big);
}

// A stamp and the head of a frame, or where one may be: at the start of `bytes`.
std::optional<FrameHead> head_at(std::span<const std::byte> bytes) {
  if (bytes.size() <= kStamp || !mavlink::is_magic(bytes[kStamp]) || stamp_at(bytes) > kLatestUs) {
    return std::nullopt;
  }
  const FrameHead head(bytes.subspan(kStamp));
  return head.has_head() ? std::optional(head) : std::nullopt;
}

bool ends_where_another_begins(std::span<const std::byte> bytes, const FrameHead& head) {
  const std::span<const std::byte> rest = bytes.subspan(kStamp + head.frame_bytes());
  return rest.empty() || head_at(rest);
}

// What a frame is: its number and who sent it.
using FrameKind = std::pair<std::uint32_t, MavlinkSender>;

FrameKind kind_of(const FrameHead& head) {
  return {head.id(), {head.system(), head.component()}};
}

class TlogReader final : public FileReader {
 public:
  TlogReader(std::span<const std::byte> bytes, const std::string& file, ReadMode mode)
      : FileReader(bytes, file, mode) {
    look_through();
  }

 private:
  // What is sent with right checksums, and by which autopilots.
  void look_through() {
    std::set<MavlinkSender> autopilots;
    mavlink::Frame frame;
    for (std::size_t at = 0; at < bytes_.size();) {
      const std::optional<FrameHead> head = head_at(bytes_.subspan(at));
      if (!head || !head->is_whole()) {
        ++at;
        continue;
      }
      if (!sound_.contains(kind_of(*head)) && read_frame(*head, frame) == FrameState::sound) {
        sound_.insert(kind_of(*head));
        if (is_of_autopilot(frame)) {
          autopilots.insert({frame.system, frame.component});
        }
      }
      at += kStamp + head->frame_bytes();
    }
    if (autopilots.size() == 1) {
      vehicle_ = *autopilots.begin();
    }
  }

  // Not, where a sender's checksum of that message is always wrong: it has another definition.
  bool is_damaged(std::span<const std::byte> bytes, const FrameHead& head,
                  mavlink::Frame& frame) const {
    const bool is_foreign = !sound_.contains(kind_of(head));
    return read_frame(head, frame) != FrameState::sound &&
           !(is_foreign && ends_where_another_begins(bytes, head));
  }

  // A frame with a wrong checksum is refused, or counted and passed over where its length is right.
  void leave_damaged(std::span<const std::byte> bytes, const FrameHead& head) {
    const bool has_length = ends_where_another_begins(bytes, head);
    if (mode() == ReadMode::strict || !has_length) {
      region_.refuse(
          at_, fmt::format("a frame is damaged: the checksum of message {} is wrong", head.id()));
    }
    pass_over(topic_called(head, mavlink::find_definition(head.id())).name);
    at_ += kStamp + head.frame_bytes();
  }

  bool step(Message& message) override {
    const std::span<const std::byte> left = bytes_.subspan(at_);
    const std::optional<FrameHead> head = head_at(left);
    if (!head && left.size() > kStamp && !mavlink::is_magic(left[kStamp])) {
      region_.refuse(at_, "no frame of MAVLink stands behind a time stamp here");
    }
    if (!head && left.size() > kStamp && stamp_at(left) > kLatestUs) {
      region_.refuse(at_,
                     fmt::format("has the time {} µs, later than the year 2116", stamp_at(left)));
    }
    if (!head || !head->is_whole()) {
      region_.refuse(at_, "is cut off within a frame, or damaged");
    }
    mavlink::Frame frame;
    if (is_damaged(left, *head, frame)) {
      leave_damaged(left, *head);
      return false;
    }
    const std::int64_t time_ns = static_cast<std::int64_t>(stamp_at(left)) * 1'000;
    message = {.topic = topic_of(*head, frame.definition),
               .receive_ns = time_ns,
               .publish_ns = time_ns,
               .sequence = head->sequence(),
               .data = frame.definition == nullptr ? head->payload() : frame.payload};
    note(message.topic, at_);
    at_ += kStamp + head->frame_bytes();
    return true;
  }

  std::size_t topic_of(const FrameHead& head, const mavlink::Definition* definition) {
    const auto [found, is_new] =
        topics_.try_emplace({kind_of(head), definition != nullptr}, topics().size());
    if (is_new) {
      found->second = add_topic(topic_called(head, definition), region_.file);
    }
    return found->second;
  }

  Topic topic_called(const FrameHead& head, const mavlink::Definition* definition) const {
    const auto [id, sender] = kind_of(head);
    return definition == nullptr ? unknown_mavlink_topic(id, sender)
                                 : mavlink_topic(*definition, sender, vehicle_);
  }

  void pass_damage() override {
    mavlink::Frame frame;
    for (++at_; at_ < bytes_.size(); ++at_) {
      const std::span<const std::byte> left = bytes_.subspan(at_);
      const std::optional<FrameHead> head = head_at(left);
      if (head && head->is_whole() && read_frame(*head, frame) == FrameState::sound) {
        return;
      }
    }
  }

  std::set<FrameKind> sound_;  // of which a frame has the right checksum
  std::optional<MavlinkSender> vehicle_;
  std::map<std::pair<FrameKind, bool>, std::size_t> topics_;  // and whether it can be decoded
};

}  // namespace

bool begins_as_tlog(std::string_view beginning) {
  mavlink::Frame frame;
  for (auto bytes = std::as_bytes(std::span(beginning)); bytes.size() > kStamp;
       bytes = bytes.subspan(1)) {
    const std::optional<FrameHead> head = head_at(bytes);
    if (head && head->is_whole() && read_frame(*head, frame) == FrameState::sound) {
      return true;
    }
  }
  return false;
}

std::unique_ptr<MessageReader> read_tlog(std::span<const std::byte> bytes, const std::string& file,
                                         ReadMode mode) {
  return std::make_unique<TlogReader>(bytes, file, mode);
}

}  // namespace kelpie::bag
