// SPDX-License-Identifier: Apache-2.0
#include "bag/dataflash_messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/text.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::bag {
namespace {

// Kinds of fields (ArduPilot, libraries/AP_Logger/README.md).
struct FieldLetter {
  char letter;
  FieldKind kind;
  std::uint32_t count = 1;
  double factor = 1.0;

  std::size_t bytes() const { return count * (is_number(kind) ? bytes_of(kind) : 1); }
};

constexpr std::array<FieldLetter, 21> kLetters{{
    {'a', FieldKind::int16, 32},       {'b', FieldKind::int8},
    {'B', FieldKind::uint8},           {'h', FieldKind::int16},
    {'H', FieldKind::uint16},          {'i', FieldKind::int32},
    {'I', FieldKind::uint32},          {'f', FieldKind::float32},
    {'d', FieldKind::float64},         {'g', FieldKind::float16},
    {'n', FieldKind::characters, 4},   {'N', FieldKind::characters, 16},
    {'Z', FieldKind::characters, 64},  {'c', FieldKind::int16, 1, 0.01},
    {'C', FieldKind::uint16, 1, 0.01}, {'e', FieldKind::int32, 1, 0.01},
    {'E', FieldKind::uint32, 1, 0.01}, {'L', FieldKind::int32, 1, 1e-7},
    {'M', FieldKind::uint8},           {'q', FieldKind::int64},
    {'Q', FieldKind::uint64},
}};

const FieldLetter* letter_called(char letter) {
  const auto* const found = std::ranges::find(kLetters, letter, &FieldLetter::letter);
  return found == kLetters.end() ? nullptr : found;
}

struct DataflashStamp {
  std::string_view name;
  char letter;
  FieldKind kind;
  std::string_view unit;
  std::int64_t unit_ns;
};
constexpr std::array<DataflashStamp, 2> kDataflashStamps{{
    {"TimeUS", 'Q', FieldKind::uint64, "us", 1'000},
    {"TimeMS", 'I', FieldKind::uint32, "ms", 1'000'000},
}};

// As other formats call it; "-": none. "UNKNOWN", "instance" and what is counted are no units.
std::string_view unit_of_label(std::string_view label) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kOthers{
      {{"deglatitude", "deg"},
       {"deglongitude", "deg"},
       {"degheading", "deg"},
       {"UNKNOWN", "-"},
       {"instance", "-"},
       {"satellites", "-"}}};
  const auto* const other =
      std::ranges::find(kOthers, label, &decltype(kOthers)::value_type::first);
  const bool is_word =
      !label.empty() && std::ranges::all_of(label, [](char c) { return c > ' ' && c <= '~'; });
  return other != kOthers.end() ? other->second : is_word ? label : "-";
}

std::string definition_line(const std::string& name, char letter, char unit_letter,
                            char factor_letter, const DataflashUnits& units) {
  for (const DataflashStamp& stamp : kDataflashStamps) {
    if (stamp.name == name && stamp.letter == letter) {
      return fmt::format("{} {} {} 1\n", letter, name, stamp.unit);
    }
  }
  const FieldLetter* const known = letter_called(letter);
  double factor = known == nullptr ? 1.0 : known->factor;
  if (const double told = units.factors[static_cast<unsigned char>(factor_letter)];
      factor == 1.0 && told != 0.0) {
    factor = told;
  }
  return fmt::format("{} {} {} {}\n", letter, name.empty() ? "?" : name,
                     unit_of_label(units.units[static_cast<unsigned char>(unit_letter)]), factor);
}

}  // namespace

std::vector<DataflashField> fields_of(const DataflashFormat& format) {
  const std::vector<std::string> names = split_text(format.columns, ',');
  std::vector<DataflashField> fields;
  std::size_t offset = 0;
  for (std::size_t k = 0; k < format.letters.size(); ++k) {
    const FieldLetter* const letter = letter_called(format.letters[k]);
    if (letter == nullptr) {
      break;
    }
    fields.push_back({k < names.size() ? names[k] : "", letter->letter, offset});
    offset += letter->bytes();
  }
  return fields;
}

std::string dataflash_definition(const DataflashFormat& format, const DataflashUnits& units) {
  const std::vector<std::string> names = split_text(format.columns, ',');
  const auto at = [](const std::string& text, std::size_t k) {
    return k < text.size() ? text[k] : '-';
  };
  std::string text;
  for (std::size_t k = 0; k < format.letters.size(); ++k) {
    text += definition_line(k < names.size() ? names[k] : "", format.letters[k],
                            at(format.units, k), at(format.factors, k), units);
  }
  return text;
}

MessageType dataflash_type_of(const Topic& topic, const MessageDefinitions& /*definitions*/) {
  MessageType type;
  type.name = topic.type;
  for (const std::string& line : split_text(topic.definition, '\n')) {
    const std::vector<std::string> words = split_text(line, ' ');
    if (line.empty()) {
      continue;
    }
    const FieldLetter* const letter = letter_called(line.front());
    double factor = 1.0;
    if (words.size() != 4 || words[0].size() != 1 || !parse_number(words[3], factor)) {
      throw InputError(topic.type, "'" + line + "' is no definition of a field");
    }
    if (letter == nullptr) {
      throw InputError(topic.type, fmt::format("{} has the format '{}', which isn't known",
                                               words[1], line.front()));
    }
    add_packed_field(type, words[1], letter->kind, letter->count, words[2] == "-" ? "" : words[2],
                     factor);
  }
  if (type.root.fields.empty()) {
    throw InputError(topic.type, "has no fields");
  }
  return type;
}

std::vector<StampPart> dataflash_stamp_of(const MessageType& type) {
  for (const DataflashStamp& stamp : kDataflashStamps) {
    const std::size_t leaf = type.find(std::string(stamp.name));
    if (leaf < type.leaves.size() && type.leaves[leaf].kind == stamp.kind) {
      return {{leaf, stamp.unit_ns}};
    }
  }
  return {};
}

}  // namespace kelpie::bag
