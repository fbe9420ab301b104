// SPDX-License-Identifier: Apache-2.0
#include "bag/ulog_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "bag/byte_reader.hpp"
#include "bag/file_reader.hpp"
#include "bag/ulog_definitions.hpp"

namespace kelpie::bag {
namespace {

constexpr std::size_t kFileHead = 16;
constexpr std::string_view kSync("\x08\x00S\x2F\x73\x13\x20\x25\x0C\xBB\x12", 11);

class UlogReader final : public FileReader {
 public:
  // Timestamps count from `begin_ns`.
  UlogReader(std::span<const std::byte> bytes, const std::string& file, ReadMode mode,
             std::int64_t begin_ns)
      : FileReader(bytes, file, mode), begin_ns_(begin_ns) {
    check_file_head();
  }

 private:
  void check_file_head() {
    constexpr std::size_t kVersion = 7;
    constexpr std::uint8_t kLatestVersion = 1;
    const std::string_view head = text_of(bytes_.first(std::min(bytes_.size(), kFileHead)));
    const auto refuse = [&](std::size_t offset, const std::string& message) {
      lose(region_.error(offset, message));
    };
    if (!begins_as_ulog(head)) {
      refuse(0, "doesn't begin as ULog files do");
    } else if (head.size() < kFileHead) {
      refuse(head.size(), "is cut off within the head of the file");
    } else if (static_cast<std::uint8_t>(head[kVersion]) > kLatestVersion) {
      refuse(kVersion, fmt::format("is ULog of version {}; 0 and 1 are read",
                                   static_cast<std::uint8_t>(head[kVersion])));
    }
    at_ = std::min(bytes_.size(), kFileHead);
  }

  // Where the last message before the next appended data may be cut off; else the file's end.
  std::size_t end_of_part() const {
    const auto next = std::ranges::find_if(appended_, [&](auto offset) { return offset > at_; });
    return next == appended_.end() ? bytes_.size() : static_cast<std::size_t>(*next);
  }

  // False for what is no message.
  bool step(Message& message) override {
    const std::optional<UlogRecord> record = ulog_record_at(bytes_, at_);
    const std::size_t end = end_of_part();
    if (end < bytes_.size() && (record ? record->end() : at_ + kUlogHead) > end) {
      at_ = end;
      return false;
    }
    if (!record) {
      refuse_record();
    }
    bool is_message = false;
    switch (record->type) {
      case 'B':
        read_flags(*record);
        break;
      case 'F':
        read_format(*record);
        break;
      case 'A':
        read_subscription(*record);
        break;
      case 'O':
        read_dropout(*record, message);
        is_message = true;
        break;
      case 'D':
        read_data(*record, message);
        is_message = true;
        break;
      default:
        break;
    }
    at_ = record->end();
    return is_message;
  }

  [[noreturn]] void refuse_record() const {
    const std::span<const std::byte> left = bytes_.subspan(at_);
    if (left.size() >= kUlogHead && !is_ulog_type(left[2])) {
      region_.refuse(at_, fmt::format("no message begins here: there is none of the type {:#04x}",
                                      std::to_integer<unsigned>(left[2])));
    }
    region_.refuse(at_, "is cut off within a message, or damaged; --recover reads what is there");
  }

  void read_flags(const UlogRecord& record) {
    ByteReader reader(record.content, region_, record.offset + kUlogHead);
    reader.number<std::uint64_t>();
    const auto incompatible = reader.number<std::uint64_t>();
    if (incompatible > 1) {
      reader.refuse(fmt::format("its flags {:#x} ask for what kelpie doesn't know", incompatible));
    }
    appended_.clear();
    for (int k = 0; k < 3 && incompatible == 1; ++k) {
      appended_.push_back(reader.number<std::uint64_t>());
    }
  }

  void read_format(const UlogRecord& record) {
    if (const std::string wrong = definitions_.add_format(text_of(record.content));
        !wrong.empty()) {
      region_.refuse(record.offset, wrong);
    }
  }

  void read_subscription(const UlogRecord& record) {
    ByteReader reader(record.content, region_, record.offset + kUlogHead);
    const auto instance = reader.number<std::uint8_t>();
    const auto id = reader.number<std::uint16_t>();
    const std::string name(text_of(reader.rest()));
    if (!is_ulog_name(name)) {
      region_.refuse(record.offset, "the name of its topic is no word of ASCII");
    }
    const Topic topic = definitions_.topic(name, instance);
    definitions_.subscribe(id, topic, add_topic(topic, region_.file));
  }

  const UlogSubscription* subscription_of(const UlogRecord& record) const {
    if (record.content.size() < sizeof(std::uint16_t)) {
      return nullptr;
    }
    const auto id = number_at<std::uint16_t>(record.content, std::endian::little);
    return definitions_.find(id);
  }
  void read_data(const UlogRecord& record, Message& message) {
    const UlogSubscription* const subscription = subscription_of(record);
    if (subscription == nullptr) {
      region_.refuse(record.offset, "a message belongs to no subscription");
    }
    const std::span<const std::byte> data = record.content.subspan(sizeof(std::uint16_t));
    if (!subscription->can_have(data.size())) {
      region_.refuse(record.offset, fmt::format("a message of {} has {} bytes; its format has {}",
                                                topics()[subscription->topic].name, data.size(),
                                                *subscription->bytes));
    }
    if (subscription->time_at) {
      const auto time_us =
          number_at<std::uint64_t>(data.subspan(*subscription->time_at), std::endian::little);
      if (time_us > static_cast<std::uint64_t>((Message::kLatestNs - begin_ns_) / 1'000)) {
        region_.refuse(record.offset,
                       fmt::format("has the time {} µs, later than the year 2116", time_us));
      }
      last_ns_ = begin_ns_ + static_cast<std::int64_t>(time_us) * 1'000;
    }
    finish(message, subscription->topic, data, record);
  }

  void read_dropout(const UlogRecord& record, Message& message) {
    finish(message,
           add_topic({.name = "dropout",
                      .type = "ulog_dropout",
                      .encoding = "ulog",
                      .definition = "ulog_dropout:uint16_t duration_ms;"},
                     region_.file),
           record.content, record);
  }

  void finish(Message& message, std::size_t topic, std::span<const std::byte> data,
              const UlogRecord& record) {
    message = {.topic = topic, .receive_ns = last_ns_, .publish_ns = last_ns_, .data = data};
    note(topic, record.offset);
  }

  bool is_sound(const UlogRecord& record) const {
    if (record.type != 'D') {
      return record.type == 'A' || record.type == 'F' || record.type == 'L';
    }
    const UlogSubscription* const subscription = subscription_of(record);
    return subscription != nullptr && subscription->bytes &&
           subscription->can_have(record.content.size() - sizeof(std::uint16_t));
  }

  // To the next mark, or to a message that another one follows.
  void pass_damage() override {
    for (++at_; at_ < bytes_.size(); ++at_) {
      const std::optional<UlogRecord> record = ulog_record_at(bytes_, at_);
      if (!record) {
        continue;
      }
      if (text_of(bytes_.subspan(at_)).starts_with(kSync)) {
        return;
      }
      if (is_sound(*record)) {
        const std::optional<UlogRecord> after = ulog_record_at(bytes_, record->end());
        if (record->end() == bytes_.size() ||
            (after && (is_sound(*after) || after->type == 'S' || after->type == 'O'))) {
          return;
        }
      }
    }
  }

  UlogDefinitions definitions_;
  std::vector<std::uint64_t> appended_;  // where data was appended
  std::int64_t begin_ns_;                // at which timestamp is 0
  std::int64_t last_ns_ = 0;
};

// By the first message of a GPS with the date; 0: there is none.
std::int64_t begin_of(std::span<const std::byte> bytes, const std::string& file) {
  UlogReader all(bytes, file, ReadMode::recover, 0);
  std::int64_t begin_ns = 0;
  for (Message message; begin_ns == 0 && all.next(message);) {
    begin_ns = ulog_begin_ns(all.topics()[message.topic], message.data);
  }
  return begin_ns;
}

}  // namespace

bool begins_as_ulog(std::string_view bytes) {
  return bytes.starts_with("ULog\x01\x12\x35");
}

std::unique_ptr<MessageReader> read_ulog(std::span<const std::byte> bytes, const std::string& file,
                                         ReadMode mode) {
  return std::make_unique<UlogReader>(bytes, file, mode, begin_of(bytes, file));
}

}  // namespace kelpie::bag
