// SPDX-License-Identifier: Apache-2.0
#include "bag/ulog_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bag/byte_reader.hpp"
#include "bag/file_reader.hpp"
#include "bag/topic_columns.hpp"
#include "bag/tuning.hpp"
#include "bag/ulog_messages.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::bag {
namespace {

// The bytes before each message's own: its size, of two bytes, and its type.
inline constexpr std::size_t kUlogHead = 3;

// A message of the file with what stands behind its head.
struct UlogRecord {
  char type = 0;
  std::size_t offset = 0;
  std::span<const std::byte> content{};

  std::size_t end() const { return offset + kUlogHead + content.size(); }
};

constexpr std::string_view kUlogTypes = "BFIMPQARDLCSO";

bool is_ascii(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return c >= ' ' && c <= '~'; });
}

std::optional<std::size_t> place_of_time(const MessageType& type) {
  std::size_t offset = 0;
  for (const Field& field : type.root.fields) {
    if (field.name == "timestamp" && field.kind == FieldKind::uint64 &&
        field.shape == FieldShape::single) {
      return offset;
    }
    offset += field.least_bytes * (field.shape == FieldShape::array ? field.size : 1);
  }
  return std::nullopt;
}

bool is_ulog_type(std::byte type) {
  return kUlogTypes.find(static_cast<char>(type)) != std::string_view::npos;
}

// The message at an offset, where a whole one can begin.
std::optional<UlogRecord> ulog_record_at(std::span<const std::byte> file, std::size_t at) {
  const std::span<const std::byte> left = file.subspan(at);
  if (left.size() < kUlogHead || !is_ulog_type(left[2])) {
    return std::nullopt;
  }
  const std::size_t size = wire::number_at<std::uint16_t>(left, std::endian::little);
  if (size > left.size() - kUlogHead) {
    return std::nullopt;
  }
  return UlogRecord{
      .type = static_cast<char>(left[2]), .offset = at, .content = left.subspan(kUlogHead, size)};
}

// The name that a text begins with: printable ASCII without blanks and colons; empty: none.
std::string_view ulog_name(std::string_view text) {
  const std::string_view beginning = text.substr(0, kTuning.longest_name + 1);
  const auto end =
      std::ranges::find_if_not(beginning, [](char c) { return c > ' ' && c <= '~' && c != ':'; });
  const auto size = static_cast<std::size_t>(end - beginning.begin());
  return size <= kTuning.longest_name ? beginning.substr(0, size) : "";
}

// What a ULog file says of the messages of one number.
struct UlogSubscription {
  bool is_there = false;
  std::size_t topic = 0;
  std::optional<std::size_t> bytes{};    // of a message; none: its format isn't known
  std::optional<std::size_t> time_at{};  // where in it the field timestamp stands

  // Whether a message can have that many bytes: some writers add the padding at its end.
  bool can_have(std::size_t size) const {
    return !bytes || (size >= *bytes && size <= *bytes + kMostUlogPadding);
  }
};

// The formats and subscriptions of a ULog file.
class UlogDefinitions {
 public:
  // "vehicle_attitude:uint64_t timestamp;float[4] q;". Returns "" or what is wrong with it.
  std::string add_format(std::string_view text) {
    const std::string name(ulog_name(text));
    const std::string_view rest = text.substr(name.size());
    if (name.empty() || !rest.starts_with(':') || !is_ascii(rest)) {
      return "is no format, as in vehicle_attitude:uint64_t timestamp;float[4] q;";
    }
    const std::string_view fields = rest.substr(1);
    const auto [found, is_new] = formats_.try_emplace(name, fields);
    return found->second == fields ? "" : "there are two formats " + name;
  }

  // "sensor_accel", of further instances "sensor_accel[1]".
  Topic topic(const std::string& name, std::uint8_t instance) const {
    return {.name = instance == 0 ? name : fmt::format("{}[{}]", name, instance),
            .type = name,
            .encoding = "ulog",
            .definition = ulog_definition(name, formats_)};
  }

  // Messages of this number are of that topic, whose index is `index`. Returns how many fields were
  // looked at, at most.
  std::size_t subscribe(std::uint16_t number, const Topic& topic, std::size_t index) {
    UlogSubscription subscription{.is_there = true, .topic = index};
    std::size_t fields = kTuning.most_fields;
    try {
      const MessageType type = ulog_type_of(topic, MessageDefinitions());
      subscription.bytes = type.root.least_bytes;
      subscription.time_at = place_of_time(type);
      fields = type.leaves.size();
    } catch (const InputError&) {  // who wants the topic will say so
    }
    subscriptions_.resize(std::max<std::size_t>(subscriptions_.size(), number + std::size_t{1}));
    subscriptions_[number] = subscription;
    return fields;
  }

  // nullptr: nobody has subscribed to them.
  const UlogSubscription* find(std::uint16_t number) const {
    const bool is_there = number < subscriptions_.size() && subscriptions_[number].is_there;
    return is_there ? &subscriptions_[number] : nullptr;
  }

 private:
  UlogFormats formats_;
  std::vector<UlogSubscription> subscriptions_;  // by number
};

// When the autopilot began, in ns since 1970, from a message of a GPS with the date; 0 for any
// other message.
std::int64_t ulog_begin_ns(const Topic& topic, std::span<const std::byte> message) {
  if (topic.type != "vehicle_gps_position" && topic.type != "sensor_gps") {
    return 0;
  }
  TopicColumns columns(topic.name);
  try {
    columns.ask(parse_column(topic.name + ":timestamp"));
    columns.ask(parse_column(topic.name + ":time_utc_usec"));
    columns.bind(topic, MessageDefinitions(), Clock::receive);
    columns.begin({});
    columns.decoder().visit(message, columns);
  } catch (const InputError&) {  // the format has no date
    return 0;
  }
  const double boot_us = columns.values()[0];
  const double utc_us = columns.values()[1];
  constexpr double kLatestUtcUs = static_cast<double>(Message::kLatestNs) / 1e3;
  return boot_us >= 0.0 && utc_us > boot_us && utc_us < kLatestUtcUs
             ? (static_cast<std::int64_t>(utc_us) - static_cast<std::int64_t>(boot_us)) * 1'000
             : 0;
}

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
      region_.refuse(at_, fmt::format("no message begins here: unknown type {:#04x}",
                                      std::to_integer<unsigned>(left[2])));
    }
    region_.refuse(at_, "is cut off within a message, or damaged; --recover reads what is there");
  }

  void read_flags(const UlogRecord& record) {
    ByteReader reader(record.content, region_, record.offset + kUlogHead);
    reader.number<std::uint64_t>();
    const auto incompatible = reader.number<std::uint64_t>();
    if (incompatible > 1) {
      reader.refuse(fmt::format("unknown incompatible flags {:#x}", incompatible));
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
    const std::string_view text = text_of(reader.rest());
    const std::string name(ulog_name(text));
    if (name.empty() || name.size() < text.size()) {
      region_.refuse(record.offset,
                     fmt::format("the topic name is not printable ASCII of at most {} letters",
                                 kTuning.longest_name));
    }
    const Topic topic = definitions_.topic(name, instance);
    const std::size_t fields = definitions_.subscribe(id, topic, add_topic(topic, region_.file));
    count_definition(topic.definition.size() + kTuning.field_bytes * fields, region_.file);
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
    const std::string_view text = text_of(record.content);
    if (record.type == 'F') {
      const std::string_view name = ulog_name(text);
      return !name.empty() && text.substr(name.size()).starts_with(':');
    }
    if (record.type == 'A') {
      constexpr std::size_t kBeforeName = 3;
      return text.size() > kBeforeName &&
             ulog_name(text.substr(kBeforeName)).size() + kBeforeName == text.size();
    }
    if (record.type != 'D') {
      return record.type == 'L';
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

// By the first message of a GPS with the date; 0: there is none, or damage before.
std::int64_t begin_of(std::span<const std::byte> bytes, const std::string& file,
                      ReadMode mode) try {
  UlogReader all(bytes, file, mode, 0);
  std::int64_t begin_ns = 0;
  for (Message message; begin_ns == 0 && all.next(message);) {
    begin_ns = ulog_begin_ns(all.topics()[message.topic], message.data);
  }
  return begin_ns;
} catch (const InputError&) {
  return 0;
}

}  // namespace

bool begins_as_ulog(std::string_view beginning) {
  return beginning.starts_with("ULog\x01\x12\x35");
}

std::unique_ptr<MessageReader> read_ulog(std::span<const std::byte> bytes, const std::string& file,
                                         ReadMode mode) {
  return std::make_unique<UlogReader>(bytes, file, mode, begin_of(bytes, file, mode));
}

}  // namespace kelpie::bag
