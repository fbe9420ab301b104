// SPDX-License-Identifier: Apache-2.0
#include "bag/dataflash_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "bag/byte_reader.hpp"
#include "bag/dataflash_definitions.hpp"
#include "bag/file_reader.hpp"

namespace kelpie::bag {
namespace {

constexpr std::array<std::byte, 2> kDataflashMagic{std::byte{0xA3}, std::byte{0x95}};
constexpr std::size_t kNoTopic = static_cast<std::size_t>(-1);
constexpr std::int64_t kBetweenLogsNs = 60'000'000'000;

class DataflashReader final : public FileReader {
 public:
  DataflashReader(std::span<const std::byte> bytes, const std::string& file, ReadMode mode)
      : FileReader(bytes, file, mode) {
    look_through();
  }

 private:
  bool is_head(std::size_t at) const {
    return at + 1 < bytes_.size() && bytes_[at] == kDataflashMagic[0] &&
           bytes_[at + 1] == kDataflashMagic[1];
  }
  // The number of the message that begins at an offset, when it is defined and whole.
  std::optional<std::uint8_t> message_at(std::size_t at) const {
    if (!is_head(at) || at + 2 >= bytes_.size()) {
      return std::nullopt;
    }
    const auto number = std::to_integer<std::uint8_t>(bytes_[at + 2]);
    const std::size_t bytes = definitions_.kind(number).bytes;
    return bytes > 0 && bytes <= bytes_.size() - at ? std::optional(number) : std::nullopt;
  }
  void pass_damage() override { at_ = next_sound(at_ + 1); }
  // Where from an offset on a message is that another one follows.
  std::size_t next_sound(std::size_t at) const {
    for (; at < bytes_.size(); ++at) {
      if (const std::optional<std::uint8_t> number = message_at(at)) {
        const std::size_t end = at + definitions_.kind(*number).bytes;
        if (end + 1 >= bytes_.size() || is_head(end)) {
          break;
        }
      }
    }
    return at;
  }
  std::span<const std::byte> payload_at(std::size_t at, std::uint8_t number) const {
    return bytes_.subspan(at + kDataflashHead, definitions_.kind(number).bytes - kDataflashHead);
  }

  // All definitions, and when the autopilot began.
  void look_through() {
    GpsClock gps;
    for (std::size_t at = 0; at < bytes_.size();) {
      const std::optional<std::uint8_t> number = message_at(at);
      if (!number) {
        at = next_sound(at + 1);
        continue;
      }
      const std::span<const std::byte> payload = payload_at(at, *number);
      at += definitions_.kind(*number).bytes;
      if (definitions_.kind(*number).is_definition) {
        definitions_.learn(*number, payload);
      } else if (gps.begin_ns() == 0 && definitions_.format(*number).name == "GPS") {
        gps.hear(definitions_.format(*number), payload);
      }
    }
    definitions_.finish();
    begin_ns_ = gps.begin_ns();
  }

  // False for what only defines others.
  bool step(Message& message) override {
    const std::optional<std::uint8_t> number = message_at(at_);
    if (!number) {
      refuse_head();
    }
    const std::span<const std::byte> payload = payload_at(at_, *number);
    const DataflashKind& kind = definitions_.kind(*number);
    if (*number == DataflashDefinitions::kFormatNumber) {
      check_format(payload);
    }
    if (!kind.is_definition) {
      const std::int64_t time_ns = time_of(kind, payload);
      message = {.topic = topic_of(*number, kind, payload),
                 .receive_ns = time_ns,
                 .publish_ns = time_ns,
                 .data = payload};
      note(message.topic, at_);
    }
    at_ += kind.bytes;
    return !kind.is_definition;
  }

  [[noreturn]] void refuse_head() const {
    if (at_ + 1 < bytes_.size() && !is_head(at_)) {
      region_.refuse(at_, "no message of DataFlash begins here");
    }
    if (at_ + 2 < bytes_.size()) {
      const auto number = std::to_integer<std::uint8_t>(bytes_[at_ + 2]);
      if (definitions_.kind(number).bytes == 0) {
        region_.refuse(at_,
                       fmt::format("a message has the number {}, which no FMT defines", number));
      }
    }
    region_.refuse(at_, "is cut off within a message, or damaged");
  }

  void check_format(std::span<const std::byte> payload) {
    if (const std::string wrong = definitions_.refusal(payload); !wrong.empty()) {
      region_.refuse(at_, wrong);
    }
    const auto defined = std::to_integer<std::uint8_t>(payload.front());
    begins_anew_ = begins_anew_ || (defined == DataflashDefinitions::kFormatNumber && has_noted());
  }

  // Never back where a second log begins.
  std::int64_t time_of(const DataflashKind& kind, std::span<const std::byte> payload) {
    if (!kind.time_at) {
      return last_ns_;
    }
    const std::uint64_t count = kind.time_us(payload);
    if (count > static_cast<std::uint64_t>(
                    std::max<std::int64_t>(0, Message::kLatestNs - begin_ns_) / 1'000)) {
      region_.refuse(at_, fmt::format("has the time {} µs, later than the year 2116", count));
    }
    const std::int64_t time_ns = begin_ns_ + static_cast<std::int64_t>(count) * 1'000;
    if (std::exchange(begins_anew_, false) && time_ns < last_ns_) {
      lose(region_.error(
          at_,
          "a second log begins before this message, whose time goes back; --recover reads it as "
          "if it had begun a minute after the end of the first"));
      begin_ns_ += last_ns_ + kBetweenLogsNs - time_ns;
      return time_of(kind, payload);
    }
    last_ns_ = time_ns;
    return time_ns;
  }

  std::size_t topic_of(std::uint8_t number, const DataflashKind& kind,
                       std::span<const std::byte> payload) {
    const std::uint8_t instance = kind.instance_at
                                      ? std::to_integer<std::uint8_t>(payload[*kind.instance_at])
                                      : std::uint8_t{0};
    std::size_t& topic = topics_[number * DataflashDefinitions::kNumbers + instance];
    if (topic == kNoTopic) {
      topic = add_topic(definitions_.topic(number, instance), region_.file);
    }
    return topic;
  }

  DataflashDefinitions definitions_;
  std::vector<std::size_t> topics_ = std::vector<std::size_t>(  // by number and instance
      DataflashDefinitions::kNumbers * DataflashDefinitions::kNumbers, kNoTopic);
  std::int64_t begin_ns_ = 0;  // at which TimeUS is 0
  std::int64_t last_ns_ = 0;
  bool begins_anew_ = false;
};

}  // namespace

bool begins_as_dataflash(std::string_view bytes) {
  return bytes.starts_with("\xA3\x95");
}

std::unique_ptr<MessageReader> read_dataflash(std::span<const std::byte> bytes,
                                              const std::string& file, ReadMode mode) {
  return std::make_unique<DataflashReader>(bytes, file, mode);
}

}  // namespace kelpie::bag
