// SPDX-License-Identifier: Apache-2.0
#include "mavlink/definition.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <iterator>
#include <ranges>

#include "core/text.hpp"
#include "mavlink/checksum.hpp"
#include "wire/scalar.hpp"

namespace kelpie::mavlink {
namespace {

// A message per line, "number NAME: fields, fields | extensions"; lines that begin with blanks go
// on with the one before. scripts/mavlink_messages.mjs writes it.
constexpr std::string_view kMessages =
#include "mavlink/messages.inc"
    ;

// "float[4] q", "float rollspeed rad/s"
Field field_of(const std::string& text, bool extension) {
  const std::vector<std::string> words = split_text(text, ' ');
  const std::string_view type = words[0];
  const std::string_view word = type.substr(0, type.find('['));
  Field field;
  field.name = words[1];
  field.unit = words.size() > 2 ? words[2] : "";
  field.extension = extension;
  field.kind = std::ranges::find(wire::kCNames, word, &wire::CName::word)->kind;
  if (word.size() < type.size()) {
    std::from_chars(type.data() + word.size() + 1, type.data() + type.size(), field.count);
  }
  return field;
}

std::string word_of(FieldKind kind) {
  return std::string(std::ranges::find(wire::kCNames, kind, &wire::CName::kind)->word);
}

std::span<const std::byte> as_bytes(std::string_view text) {
  return std::as_bytes(std::span(text));
}

// Of the basic fields in the order they are sent in, folded to a byte.
std::uint8_t crc_extra_of(const Definition& definition) {
  std::uint16_t crc = checksum(as_bytes(definition.name + " "));
  for (const Field& field : definition.fields) {
    if (!field.extension) {
      crc = checksum(as_bytes(word_of(field.kind) + " " + field.name + " "), crc);
      if (field.count > 1) {
        const auto count = static_cast<std::byte>(field.count);
        crc = checksum(std::span(&count, 1), crc);
      }
    }
  }
  return static_cast<std::uint8_t>((crc & 0xFFU) ^ (crc >> 8U));
}

Definition definition_of(const std::string& text) {
  const std::size_t blank = text.find(' ');
  const std::size_t colon = text.find(':');
  Definition definition;
  std::from_chars(text.data(), text.data() + blank, definition.id);
  definition.name = text.substr(blank + 1, colon - blank - 1);
  bool extension = false;
  for (const std::string& part : split_text(text.substr(colon + 1), '|')) {
    for (const std::string& one : split_text(part, ',')) {
      Field& field = definition.fields.emplace_back(field_of(one, extension));
      field.offset = definition.all_bytes;
      definition.all_bytes += field.count * bytes_of(field.kind);
    }
    definition.basic_bytes = extension ? definition.basic_bytes : definition.all_bytes;
    extension = true;
  }
  definition.crc_extra = crc_extra_of(definition);
  return definition;
}

std::vector<Definition> parsed(std::string_view messages) {
  std::vector<std::string> texts;
  for (const std::string_view line :
       std::views::split(messages, '\n') | std::views::transform([](auto part) {
         return std::string_view(part.begin(), part.end());
       })) {
    if (line.starts_with(' ')) {
      texts.back() += " " + std::string(trimmed(line));
    } else if (!line.empty()) {
      texts.emplace_back(line);
    }
  }
  std::vector<Definition> made;
  std::ranges::transform(texts, std::back_inserter(made), definition_of);
  return made;
}

}  // namespace

const Field* Definition::find(std::string_view field) const {
  const auto found = std::ranges::find(fields, field, &Field::name);
  return found == fields.end() ? nullptr : &*found;
}

std::span<const Definition> definitions() {
  static const std::vector<Definition> all = parsed(kMessages);
  return all;
}

const Definition* find_definition(std::uint32_t id) {
  const auto found = std::ranges::lower_bound(definitions(), id, {}, &Definition::id);
  return found == definitions().end() || found->id != id ? nullptr : &*found;
}

const Definition* find_definition(std::string_view name) {
  const auto found = std::ranges::find(definitions(), name, &Definition::name);
  return found == definitions().end() ? nullptr : &*found;
}

double number_at(const Field& field, std::span<const std::byte> payload, std::size_t index) {
  const std::size_t bytes = bytes_of(field.kind);
  const std::size_t offset = std::min(payload.size(), field.offset + index * bytes);
  const std::span<const std::byte> there =
      payload.subspan(offset).first(std::min(bytes, payload.size() - offset));
  std::array<std::byte, sizeof(double)> whole{};
  std::ranges::copy(there, whole.begin());
  return wire::number_of(field.kind, whole, std::endian::little);
}

std::string text_at(const Field& field, std::span<const std::byte> payload) {
  const std::size_t offset = std::min(payload.size(), field.offset);
  return wire::text_of(payload.subspan(offset, std::min(payload.size() - offset, field.count)));
}

}  // namespace kelpie::mavlink
