// SPDX-License-Identifier: Apache-2.0
#include "bag/dataflash_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bag/byte_reader.hpp"
#include "bag/dataflash_messages.hpp"
#include "bag/file_reader.hpp"
#include "bag/topic_columns.hpp"
#include "bag/tuning.hpp"
#include "kelpie/core/error.hpp"
#include "wire/scalar.hpp"

namespace kelpie::bag {
namespace {

constexpr std::size_t kNumbers = 256;
constexpr std::uint8_t kFormatNumber = 128;  // of FMT, which defines itself as well
constexpr std::size_t kFormatBytes = 89;

std::uint8_t byte_at(std::span<const std::byte> bytes, std::size_t at) {
  return std::to_integer<std::uint8_t>(bytes[at]);
}

std::string word_at(std::span<const std::byte> bytes, std::size_t at, std::size_t length) {
  return wire::text_of(bytes.subspan(at, length));
}

bool is_one_word(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return c > ' ' && c <= '~' && c != ':'; });
}

DataflashFormat format_in(std::span<const std::byte> payload) {
  return {.bytes = byte_at(payload, 1),
          .name = word_at(payload, 2, 4),
          .letters = word_at(payload, 6, 16),
          .columns = word_at(payload, 22, 64)};
}

bool is_possible(std::uint8_t number, const DataflashFormat& format) {
  return format.bytes > kDataflashHead && !format.name.empty() && is_one_word(format.name) &&
         is_one_word(format.letters) && is_one_word(format.columns) &&
         (number != kFormatNumber || format.bytes == kFormatBytes);
}

bool is_definition(const DataflashFormat& format) {
  return (format.name == "FMTU" && format.letters == "QBNN") ||
         (format.name == "UNIT" && format.letters == "QbZ") ||
         (format.name == "MULT" && format.letters == "Qbd");
}

// What is needed of every message of one number; offsets are within its own bytes.
struct DataflashKind {
  std::size_t bytes = 0;       // with its head; 0: no such message
  bool is_definition = false;  // FMT, FMTU, UNIT or MULT
  std::optional<std::size_t> instance_at{};
  std::optional<std::size_t> time_at{};
  bool is_in_ms = false;  // its time; else µs

  // Requires time_at.
  std::uint64_t time_us(std::span<const std::byte> payload) const {
    const std::span<const std::byte> field = payload.subspan(*time_at);
    return is_in_ms
               ? std::uint64_t{1'000} * wire::number_at<std::uint32_t>(field, std::endian::little)
               : wire::number_at<std::uint64_t>(field, std::endian::little);
  }
};

// What the messages FMT, FMTU, UNIT and MULT of a file define. The first definition of a number is
// the one that holds.
class DataflashDefinitions {
 public:
  DataflashDefinitions() { kinds_[kFormatNumber] = {.bytes = kFormatBytes, .is_definition = true}; }

  // Of one of the four messages, of this number.
  void learn(std::uint8_t number, std::span<const std::byte> payload) {
    if (number == kFormatNumber) {
      learn_format(payload);
    } else {
      learn_unit(formats_[number], payload);
    }
  }

  // Once all are learned: finds times and instances.
  void finish() {
    for (std::size_t number = 0; number < kNumbers; ++number) {
      find_fields(number);
    }
  }

  const DataflashKind& kind(std::uint8_t number) const { return kinds_[number]; }
  const DataflashFormat& format(std::uint8_t number) const { return formats_[number]; }

  // What is wrong with an FMT: "", or that it can't be or isn't the definition that holds.
  std::string refusal(std::span<const std::byte> format_payload) const {
    const DataflashFormat format = format_in(format_payload);
    const std::uint8_t number = byte_at(format_payload, 0);
    if (!is_possible(number, format)) {
      return fmt::format("the FMT definition of message {} is impossible", number);
    }
    DataflashFormat known = formats_[number];
    known.units.clear();
    known.factors.clear();
    return known == format
               ? ""
               : fmt::format("two FMT definitions of message {} ({}) differ", number, format.name);
  }

  // The topic of a number's messages; of two numbers of one name the later is "ATT/77".
  Topic topic(std::uint8_t number, std::uint8_t instance) const {
    const DataflashFormat& format = formats_[number];
    const bool is_first =
        &format == &*std::ranges::find(formats_, format.name, &DataflashFormat::name);
    const std::string name = is_first ? format.name : fmt::format("{}/{}", format.name, number);
    return {.name = kinds_[number].instance_at ? fmt::format("{}[{}]", name, instance) : name,
            .type = name,
            .encoding = "dataflash",
            .definition = dataflash_definition(format, units_)};
  }

 private:
  void learn_format(std::span<const std::byte> payload) {
    const DataflashFormat format = format_in(payload);
    const std::uint8_t number = byte_at(payload, 0);
    if (formats_[number].bytes > 0 || !is_possible(number, format)) {
      return;
    }
    // FMTU may come before FMT.
    formats_[number].bytes = format.bytes;
    formats_[number].name = format.name;
    formats_[number].letters = format.letters;
    formats_[number].columns = format.columns;
    kinds_[number].bytes = format.bytes;
    kinds_[number].is_definition = number == kFormatNumber || is_definition(format);
  }

  // Each begins with a time of 8 bytes, and the number or letter that it is about.
  void learn_unit(const DataflashFormat& format, std::span<const std::byte> payload) {
    constexpr std::size_t kAbout = 8;
    constexpr std::size_t kWord = 16;
    constexpr std::size_t kLabel = 64;
    const std::span<const std::byte> rest = payload.subspan(std::min(payload.size(), kAbout + 1));
    if (format.name == "FMTU" && rest.size() >= 2 * kWord) {
      DataflashFormat& about = formats_[byte_at(payload, kAbout)];
      about.units = word_at(rest, 0, kWord);
      about.factors = word_at(rest, kWord, kWord);
    } else if (format.name == "UNIT" && rest.size() >= kLabel) {
      units_.units[byte_at(payload, kAbout)] = word_at(rest, 0, kLabel);
    } else if (format.name == "MULT" && rest.size() >= sizeof(double)) {
      units_.factors[byte_at(payload, kAbout)] = wire::number_at<double>(rest, std::endian::little);
    }
  }

  void find_fields(std::size_t number) {
    const DataflashFormat& format = formats_[number];
    DataflashKind& kind = kinds_[number];
    const std::vector<DataflashField> fields = fields_of(format);
    for (std::size_t k = 0; k < fields.size(); ++k) {
      const auto& [name, letter, offset] = fields[k];
      const auto has_bytes = [&, at = offset](std::size_t bytes) {
        return kDataflashHead + at + bytes <= format.bytes;
      };
      const bool is_byte = letter == 'b' || letter == 'B' || letter == 'M';
      if (is_byte && k < format.units.size() && format.units[k] == '#' && has_bytes(1)) {
        kind.instance_at = offset;
      }
      const bool is_us = name == "TimeUS" && letter == 'Q' && has_bytes(8);
      const bool is_ms = name == "TimeMS" && letter == 'I' && has_bytes(4);
      if (is_us || is_ms) {
        kind.time_at = offset;
        kind.is_in_ms = is_ms;
      }
    }
  }

  std::array<DataflashFormat, kNumbers> formats_;
  std::array<DataflashKind, kNumbers> kinds_;
  DataflashUnits units_;
};

// When the autopilot began, by the first fix of its GPS: weeks and ms of GPS's time, which is 18 s
// ahead since 2017 (of older logs the date is a few seconds off).
class GpsClock {
 public:
  // A message GPS. What has no such fields tells nothing.
  void hear(const DataflashFormat& format, std::span<const std::byte> payload) {
    constexpr double kFix = 3.0;
    constexpr double kMostWeeks = 7'000.0;  // until the year 2114
    constexpr double kMostMs = 604'800'000.0;
    constexpr double kMostUs = 1e15;
    constexpr std::int64_t kGpsBegan = 315'964'800;
    constexpr std::int64_t kLeapSeconds = 18;
    if (!columns_.is_bound() && !has_failed_) {
      bind(format);
    }
    if (has_failed_ || begin_ns_ != 0) {
      return;
    }
    try {
      columns_.begin({});
      columns_.decoder().visit(payload, columns_);
    } catch (const InputError&) {  // the reader will say so
      return;
    }
    const auto is_within = [&](std::size_t k, double low, double high) {
      return columns_.values()[k] >= low && columns_.values()[k] <= high;
    };
    const auto whole = [&](std::size_t k) {
      return static_cast<std::int64_t>(columns_.values()[k]);
    };
    if (is_within(0, 0.0, kMostUs) && is_within(1, 0.0, kMostMs) && is_within(2, 1.0, kMostWeeks) &&
        columns_.values()[3] >= kFix) {
      const std::int64_t begin_ns =
          (kGpsBegan - kLeapSeconds + whole(2) * 604'800) * 1'000'000'000 + whole(1) * 1'000'000 -
          whole(0) * 1'000;
      begin_ns_ = std::max<std::int64_t>(begin_ns, 0);
    }
  }

  // In ns since 1970; 0: not known.
  std::int64_t begin_ns() const { return begin_ns_; }

 private:
  void bind(const DataflashFormat& format) {
    try {
      for (const char* const column : {"GPS:TimeUS", "GPS:GMS", "GPS:GWk", "GPS:Status"}) {
        columns_.ask(parse_column(column));
      }
      columns_.bind({.name = "GPS",
                     .type = "GPS",
                     .encoding = "dataflash",
                     .definition = dataflash_definition(format)},
                    MessageDefinitions(), Clock::receive);
    } catch (const InputError&) {  // a message of other fields tells nothing
      has_failed_ = true;
    }
  }

  TopicColumns columns_{"GPS"};
  std::int64_t begin_ns_ = 0;
  bool has_failed_ = false;
};

constexpr std::array<std::byte, 2> kDataflashMagic{std::byte{0xA3}, std::byte{0x95}};
constexpr std::size_t kNoTopic = static_cast<std::size_t>(-1);

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
    if (*number == kFormatNumber) {
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
    begins_anew_ = begins_anew_ || (defined == kFormatNumber && has_noted());
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
          "a second log begins before this message, whose time goes back; --recover moves the "
          "second log to one minute after the end of the first"));
      begin_ns_ += last_ns_ + kTuning.between_logs_ns - time_ns;
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
    std::size_t& topic = topics_[number * kNumbers + instance];
    if (topic == kNoTopic) {
      topic = add_topic(definitions_.topic(number, instance), region_.file);
    }
    return topic;
  }

  DataflashDefinitions definitions_;
  std::vector<std::size_t> topics_ = std::vector<std::size_t>(  // by number and instance
      kNumbers * kNumbers, kNoTopic);
  std::int64_t begin_ns_ = 0;  // at which TimeUS is 0
  std::int64_t last_ns_ = 0;
  bool begins_anew_ = false;
};

}  // namespace

bool begins_as_dataflash(std::string_view beginning) {
  return beginning.starts_with("\xA3\x95");
}

std::unique_ptr<MessageReader> read_dataflash(std::span<const std::byte> bytes,
                                              const std::string& file, ReadMode mode) {
  return std::make_unique<DataflashReader>(bytes, file, mode);
}

}  // namespace kelpie::bag
