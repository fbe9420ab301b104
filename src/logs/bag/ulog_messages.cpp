// SPDX-License-Identifier: Apache-2.0
#include "bag/ulog_messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>

#include "bag/tuning.hpp"
#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "wire/scalar.hpp"

namespace kelpie::bag {
namespace {

constexpr std::uint64_t kMostUlogBytes = UINT16_MAX;  // a message's size has 16 bits
constexpr std::string_view kPadding = "_padding";

const wire::CName* ulog_number_called(std::string_view name) {
  const auto* const found = std::ranges::find(wire::kCNames, name, &wire::CName::word);
  return found == wire::kCNames.end() ? nullptr : found;
}

// A field as a format has it: "float[3] x".
struct UlogField {
  std::string type;
  std::string name;
  std::uint32_t count = 0;  // 0: no array
};

UlogField parse_ulog_field(const std::string& format, const std::string& text) {
  const std::vector<std::string> words = split_text(text, ' ');
  UlogField field;
  if (words.size() == 2) {
    const std::size_t open = std::min(words[0].find('['), words[0].size());
    field.type = words[0].substr(0, open);
    field.name = words[1];
    if (open < words[0].size()) {
      const char* const end = words[0].data() + words[0].size();
      const auto [stop, error] = std::from_chars(words[0].data() + open + 1, end, field.count);
      const bool is_good = error == std::errc{} && stop + 1 == end && *stop == ']' &&
                           field.count > 0 && field.count <= kMostUlogBytes;
      field.type = is_good ? field.type : "";
    }
  }
  const auto is_part_of_name = [](char c) { return c > ' ' && c <= '~' && c != '[' && c != '.'; };
  if (field.type.empty() || field.name.empty() ||
      !std::ranges::all_of(field.name, is_part_of_name)) {
    throw InputError(format, "'" + text.substr(0, 80) + "' is no field");
  }
  return field;
}

std::vector<UlogField> parse_ulog_fields(const std::string& format, const UlogFormats& formats) {
  const auto found = formats.find(format);
  if (found == formats.end()) {
    throw InputError(format, "is a type that no format of the file defines");
  }
  std::vector<UlogField> fields;
  for (const std::string& text : split_text(found->second, ';')) {
    if (!text.empty()) {
      fields.push_back(parse_ulog_field(format, text));
    }
  }
  if (fields.empty()) {
    throw InputError(format, "is a format without fields");
  }
  return fields;
}

class UlogTree {
 public:
  UlogTree(const UlogFormats& formats, MessageType& type) : formats_(formats), type_(type) {}

  void fill(Field& structure, const std::string& format, const std::string& path,
            std::size_t depth) {
    if (depth > kTuning.deepest_type) {
      throw InputError(format, "holds itself, or formats within formats more than 32 deep");
    }
    std::vector<UlogField> fields = parse_ulog_fields(format, formats_);
    if (depth == 0 && fields.size() > 1 && fields.back().name.starts_with(kPadding)) {
      fields.pop_back();
    }
    for (const UlogField& from : fields) {
      structure.fields.push_back(field_of(from, path, depth));
      const Field& field = structure.fields.back();
      const bool is_many = field.shape == FieldShape::array;
      structure.least_bytes += field.least_bytes * (is_many ? field.size : 1);
      if (structure.least_bytes > kMostUlogBytes) {
        throw InputError(format, "takes more than the 65535 bytes of a message");
      }
    }
  }

 private:
  Field field_of(const UlogField& from, const std::string& path, std::size_t depth) {
    if (++fields_ > kTuning.most_fields) {
      throw InputError(type_.name, fmt::format("has more than {} fields", kTuning.most_fields));
    }
    check_name_length(type_.name, from.name);
    const wire::CName* const number = ulog_number_called(from.type);
    const bool is_text = number != nullptr &&
                         (number->kind == FieldKind::characters || from.name.starts_with(kPadding));
    const bool is_many = from.count > 0 && !is_text;
    Field field;
    field.name = from.name;
    field.shape = is_many ? FieldShape::array : FieldShape::single;
    field.size = std::max<std::uint32_t>(1, from.count);
    const std::string own_path =
        path + (path.empty() ? "" : ".") + from.name + (is_many ? "[]" : "");
    if (number == nullptr) {
      fill(field, from.type, own_path, depth + 1);
      return field;
    }
    const std::size_t bytes = is_number(number->kind) ? bytes_of(number->kind) : 1;
    field.kind = is_text ? FieldKind::characters : number->kind;
    field.size = is_text ? static_cast<std::uint32_t>(field.size * bytes) : field.size;
    field.least_bytes = is_text ? field.size : bytes;
    field.leaf = type_.leaves.size();
    type_.leaves.push_back({.path = own_path, .kind = field.kind});
    return field;
  }

  const UlogFormats& formats_;
  MessageType& type_;
  std::size_t fields_ = 0;
};

// The formats that `name` holds, without those in `seen` already. Deeper ones are of no use:
// UlogTree refuses the type.
void collect_formats(const std::string& name, const UlogFormats& formats, std::size_t depth,
                     std::set<std::string>& seen, std::string& text) {
  const auto found = formats.find(name);
  if (depth > kTuning.deepest_type || found == formats.end() || !seen.insert(name).second) {
    return;
  }
  text += name + ":" + found->second + "\n";
  for (const std::string& field : split_text(found->second, ';')) {
    const std::string type = field.substr(0, field.find_first_of("[ "));
    if (ulog_number_called(type) == nullptr) {
      collect_formats(type, formats, depth + 1, seen, text);
    }
  }
}

}  // namespace

std::string ulog_definition(const std::string& name, const UlogFormats& formats) {
  std::set<std::string> seen;
  std::string text;
  collect_formats(name, formats, 0, seen, text);
  return text;
}

MessageType ulog_type_of(const Topic& topic, const MessageDefinitions& /*definitions*/) {
  UlogFormats formats;
  for (const std::string& line : split_text(topic.definition, '\n')) {
    const std::size_t colon = std::min(line.find(':'), line.size());
    formats.emplace(line.substr(0, colon), line.substr(std::min(colon + 1, line.size())));
  }
  MessageType type;
  type.name = topic.type;
  UlogTree(formats, type).fill(type.root, topic.type, "", 0);
  return type;
}

void visit_ulog_numbers(const MessageType& type, std::span<const std::byte> message,
                        NumberVisitor& visitor) {
  const std::size_t bytes = type.root.least_bytes;
  const bool is_padded = message.size() > bytes && message.size() <= bytes + kMostUlogPadding;
  visit_packed_numbers(type, is_padded ? message.first(bytes) : message, visitor);
}

std::vector<StampPart> ulog_stamp_of(const MessageType& type) {
  const std::size_t leaf = type.find("timestamp");
  return leaf < type.leaves.size() && type.leaves[leaf].kind == FieldKind::uint64
             ? std::vector<StampPart>{{leaf, 1'000}}
             : std::vector<StampPart>{};
}

}  // namespace kelpie::bag
