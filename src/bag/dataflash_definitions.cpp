// SPDX-License-Identifier: Apache-2.0
#include "bag/dataflash_definitions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <string_view>

#include "kelpie/core/error.hpp"

namespace kelpie::bag {
namespace {

constexpr std::size_t kFormatBytes = 89;

std::uint8_t byte_at(std::span<const std::byte> bytes, std::size_t at) {
  return std::to_integer<std::uint8_t>(bytes[at]);
}

// Text in a fixed number of bytes.
std::string word_at(std::span<const std::byte> bytes, std::size_t at, std::size_t length) {
  const std::string_view all(reinterpret_cast<const char*>(bytes.data()) + at, length);  // NOLINT
  return std::string(all.substr(0, std::min(all.find('\0'), all.size())));
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
         (number != DataflashDefinitions::kFormatNumber || format.bytes == kFormatBytes);
}

bool is_definition(const DataflashFormat& format) {
  return (format.name == "FMTU" && format.letters == "QBNN") ||
         (format.name == "UNIT" && format.letters == "QbZ") ||
         (format.name == "MULT" && format.letters == "Qbd");
}

}  // namespace

std::uint64_t DataflashKind::time_us(std::span<const std::byte> payload) const {
  const std::span<const std::byte> field = payload.subspan(*time_at);
  return is_in_ms
             ? std::uint64_t{1'000} * wire::number_at<std::uint32_t>(field, std::endian::little)
             : wire::number_at<std::uint64_t>(field, std::endian::little);
}

DataflashDefinitions::DataflashDefinitions() {
  kinds_[kFormatNumber] = {.bytes = kFormatBytes, .is_definition = true};
}

void DataflashDefinitions::learn(std::uint8_t number, std::span<const std::byte> payload) {
  if (number == kFormatNumber) {
    learn_format(payload);
  } else {
    learn_unit(formats_[number], payload);
  }
}

void DataflashDefinitions::learn_format(std::span<const std::byte> payload) {
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
void DataflashDefinitions::learn_unit(const DataflashFormat& format,
                                      std::span<const std::byte> payload) {
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

void DataflashDefinitions::finish() {
  for (std::size_t number = 0; number < kNumbers; ++number) {
    find_fields(number);
  }
}

void DataflashDefinitions::find_fields(std::size_t number) {
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

std::string DataflashDefinitions::refusal(std::span<const std::byte> format_payload) const {
  const DataflashFormat format = format_in(format_payload);
  const std::uint8_t number = byte_at(format_payload, 0);
  if (!is_possible(number, format)) {
    return fmt::format("FMT defines message {} as what it can't be", number);
  }
  DataflashFormat known = formats_[number];
  known.units.clear();
  known.factors.clear();
  return known == format ? ""
                         : fmt::format("FMT defines message {} as {}, and elsewhere otherwise",
                                       number, format.name);
}

Topic DataflashDefinitions::topic(std::uint8_t number, std::uint8_t instance) const {
  const DataflashFormat& format = formats_[number];
  const auto first = std::ranges::find(formats_, format.name, &DataflashFormat::name);
  const bool is_first = first - formats_.begin() == number;
  const std::string name = is_first ? format.name : fmt::format("{}/{}", format.name, number);
  return {.name = kinds_[number].instance_at ? fmt::format("{}[{}]", name, instance) : name,
          .type = name,
          .encoding = "dataflash",
          .definition = dataflash_definition(format, units_)};
}

void GpsClock::bind(const DataflashFormat& format) {
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

void GpsClock::hear(const DataflashFormat& format, std::span<const std::byte> payload) {
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
  const auto whole = [&](std::size_t k) { return static_cast<std::int64_t>(columns_.values()[k]); };
  if (is_within(0, 0.0, kMostUs) && is_within(1, 0.0, kMostMs) && is_within(2, 1.0, kMostWeeks) &&
      columns_.values()[3] >= kFix) {
    const std::int64_t begin_ns = (kGpsBegan - kLeapSeconds + whole(2) * 604'800) * 1'000'000'000 +
                                  whole(1) * 1'000'000 - whole(0) * 1'000;
    begin_ns_ = std::max<std::int64_t>(begin_ns, 0);
  }
}

}  // namespace kelpie::bag
