// SPDX-License-Identifier: Apache-2.0
#include "bag/alog_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "bag/byte_reader.hpp"
#include "core/seconds.hpp"
#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "wire/scalar.hpp"

namespace kelpie::bag {
namespace {

constexpr std::string_view kComment = "%";
constexpr std::string_view kStart = "LOGSTART";

// Lines of a text, one after the other.
struct AlogCursor {
  std::string_view text;
  std::size_t at = 0;
  std::size_t line = 0;  // the number of the one taken last, from 1 on
  bool is_cut = false;   // it has no end

  bool done() const { return at >= text.size(); }
  std::string_view next() {
    const std::size_t begin = at;
    const std::size_t end = text.find('\n', begin);
    is_cut = end == std::string_view::npos;
    at = is_cut ? text.size() : end + 1;
    ++line;
    std::string_view taken = text.substr(begin, (is_cut ? at : end) - begin);
    if (taken.ends_with('\r')) {
      taken.remove_suffix(1);
    }
    return trimmed(taken);
  }
};

struct AlogEntry {
  double time_s = 0.0;  // since LOGSTART
  std::string_view variable{};
  std::string_view source{};
  std::string_view value{};
};

std::string_view take_word(std::string_view& line) {
  const std::string_view word = line.substr(0, line.find_first_of(" \t"));
  line = trimmed(line.substr(word.size()));
  return word;
}

bool is_text(std::string_view line) {
  return std::ranges::all_of(
      line, [](char c) { return static_cast<unsigned char>(c) >= 0x20 || c == '\t'; });
}

std::optional<double> alog_number(std::string_view text) {
  double value = 0.0;
  return parse_number(text, value) ? std::optional(value) : std::nullopt;
}

std::optional<AlogEntry> entry_of(std::string_view line) {
  const bool may_be = !line.empty() && (line.front() == '-' || line.front() == '.' ||
                                        (line.front() >= '0' && line.front() <= '9'));
  const auto time = may_be ? alog_number(take_word(line)) : std::nullopt;
  if (!time || !is_text(line)) {
    return std::nullopt;
  }
  AlogEntry entry{.time_s = *time};
  entry.variable = take_word(line);
  entry.source = take_word(line);
  entry.value = line;
  return entry.source.empty() ? std::nullopt : std::optional(entry);
}

bool is_passed_over(std::string_view line) {
  return line.empty() || line.starts_with(kComment);
}

void append_text(std::vector<std::byte>& payload, std::string_view text) {
  const std::size_t begin = payload.size();
  payload.resize(begin + sizeof(std::uint32_t) + text.size());
  const std::span<std::byte> place = std::span(payload).subspan(begin);
  wire::store_number(place, wire::FieldKind::uint32, static_cast<double>(text.size()));
  std::ranges::copy(std::as_bytes(std::span(text)), place.begin() + sizeof(std::uint32_t));
}

class AlogReader final : public MessageReader {
 public:
  AlogReader(std::span<const std::byte> bytes, const std::string& file, ReadMode mode)
      : MessageReader(mode, file), file_(file) {
    cursor_.text = text_of(bytes);
    look_through();
  }

  Place place() const override {
    return {.file = file_,
            .line = last_line_,
            .field = last_topic_ < topics().size() ? topics()[last_topic_].name : ""};
  }

 private:
  struct Variable {
    std::size_t values = 0;
    std::size_t numbers = 0;
    std::optional<std::size_t> topic{};

    bool is_number() const { return 2 * numbers > values; }
  };

  [[noreturn]] void refuse_line(const std::string& message) const {
    throw InputError({.file = file_, .line = cursor_.line}, message);
  }

  // What kind the variables are, and when the log begins.
  void look_through() {
    AlogCursor all = cursor_;
    std::optional<std::string_view> start;
    while (!all.done()) {
      const std::string_view line = all.next();
      if (is_passed_over(line)) {
        if (const std::size_t found = line.find(kStart);
            !start && found != std::string_view::npos) {
          start = trimmed(line.substr(found + kStart.size()));
        }
      } else if (const auto entry = entry_of(line)) {
        Variable& variable = variables_[entry->variable];
        ++variable.values;
        variable.numbers += alog_number(entry->value) ? 1 : 0;
      }
    }
    take_start(start.value_or(""));
  }

  void take_start(std::string_view text) {
    const auto value = alog_number(text);
    if (value && *value >= 0.0 && *value < seconds(Message::kLatestNs)) {
      start_ns_ = nanoseconds(*value);
      return;
    }
    lose(InputError({.file = file_, .field = std::string(kStart)},
                    fmt::format("'{}' is no time in s since 1970", text.substr(0, 40))));
  }

  bool at_end() const override { return cursor_.done(); }

  bool step(Message& message) override {
    const std::string_view line = cursor_.next();
    if (is_passed_over(line)) {
      return false;
    }
    const auto entry = entry_of(line);
    if (!entry) {
      refuse_line("is no line of time, variable, source and value, and does not continue a text");
    }
    if (cursor_.is_cut) {
      refuse_line("the file is cut off within this line");
    }
    const double latest_s = seconds(Message::kLatestNs - start_ns_);
    const bool is_in_range =
        entry->time_s * 1e9 + static_cast<double>(start_ns_) >= 0.0 && entry->time_s < latest_s;
    if (!is_in_range) {
      refuse_line(fmt::format("the time of {} s is out of range", entry->time_s));
    }
    Variable& variable = variables_[entry->variable];
    last_topic_ = topic_of(entry->variable, variable);
    last_line_ = cursor_.line;
    put_together(*entry, variable.is_number());
    const std::int64_t time_ns = start_ns_ + nanoseconds(entry->time_s);
    message = {
        .topic = last_topic_, .receive_ns = time_ns, .publish_ns = time_ns, .data = payload_};
    return true;
  }

  std::size_t topic_of(std::string_view name, Variable& variable) {
    if (!variable.topic) {
      const std::string kind = variable.is_number() ? "float64" : "string";
      variable.topic = add_topic({.name = std::string(name),
                                  .type = variable.is_number() ? "moos/Number" : "moos/Text",
                                  .encoding = "ros1",
                                  .definition = fmt::format("{} value\nstring source\n", kind)},
                                 file_);
    }
    return *variable.topic;
  }

  void put_together(const AlogEntry& entry, bool is_number) {
    payload_.clear();
    if (is_number) {
      payload_.resize(sizeof(double));
      wire::store_number(
          payload_, wire::FieldKind::float64,
          alog_number(entry.value).value_or(std::numeric_limits<double>::quiet_NaN()));
    } else {
      append_text(payload_, with_what_follows(entry.value));
    }
    append_text(payload_, entry.source);
  }

  // A text, with the lines behind it that are none of their own.
  std::string_view with_what_follows(std::string_view value) {
    AlogCursor ahead = cursor_;
    while (!ahead.done()) {
      const std::string_view line = ahead.next();
      if (line.starts_with(kComment) || ahead.is_cut || entry_of(line) || !is_text(line)) {
        break;
      }
      if (!line.empty()) {
        cursor_ = ahead;
        const char* const begin = value.empty() ? line.data() : value.data();
        value = {begin, static_cast<std::size_t>(line.data() + line.size() - begin)};
      }
    }
    return value;
  }

  std::string file_;
  AlogCursor cursor_;
  std::map<std::string_view, Variable> variables_;
  std::int64_t start_ns_ = 0;
  std::vector<std::byte> payload_;
  std::size_t last_topic_ = static_cast<std::size_t>(-1);
  std::size_t last_line_ = 0;
};

}  // namespace

bool begins_as_alog(std::string_view beginning) {
  AlogCursor cursor{.text = beginning};
  while (!cursor.done()) {
    const std::string_view line = cursor.next();
    if (!is_passed_over(line) || !is_text(line)) {
      return false;
    }
    if (line.find(kStart) != std::string_view::npos) {
      return true;
    }
  }
  return false;
}

std::unique_ptr<MessageReader> read_alog(std::span<const std::byte> bytes, const std::string& file,
                                         ReadMode mode) {
  return std::make_unique<AlogReader>(bytes, file, mode);
}

}  // namespace kelpie::bag
