// SPDX-License-Identifier: Apache-2.0
#include "bag/message_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "kelpie/core/error.hpp"

namespace kelpie::bag {
namespace {

constexpr std::array<std::byte, 4> kLittleEndianCdr{std::byte{0}, std::byte{1}, std::byte{0},
                                                    std::byte{0}};

void require_number(std::string_view path, const Field& field, double value) {
  if (!is_number(field.kind)) {
    throw InputError(path, "isn't a number in this type");
  }
  if (!wire::holds(field.kind, value)) {
    throw InputError(path, fmt::format("{} is not an integer within range", value));
  }
}

}  // namespace

MessageBuilder::MessageBuilder(MessageType type)
    : type_(std::move(type)), root_(zero_of(type_.root, false)) {}

MessageBuilder::Value MessageBuilder::zero_of(const Field& field, bool element) {
  Value value;
  if (!element && field.shape != FieldShape::single) {
    value.parts.resize(field.shape == FieldShape::array ? field.size : 0, zero_of(field, true));
  } else if (field.kind == FieldKind::structure) {
    for (const Field& part : field.fields) {
      value.parts.push_back(zero_of(part, false));
    }
  }
  return value;
}

MessageBuilder::Target MessageBuilder::find(std::string_view path) {
  Target at{&type_.root, &root_, false};
  for (std::string_view rest = path; !rest.empty();) {
    const std::string_view step = rest.substr(0, rest.find('.'));
    rest.remove_prefix(std::min(step.size() + 1, rest.size()));
    const std::string_view name = step.substr(0, step.find('['));
    const std::vector<Field>& fields = at.field->fields;
    const auto found = std::ranges::find(fields, name, &Field::name);
    if (found == fields.end() || (at.field->shape != FieldShape::single && !at.element)) {
      throw InputError(path, fmt::format("{} has no such field", type_.name));
    }
    at = {&*found, &at.value->parts[static_cast<std::size_t>(found - fields.begin())], false};
    if (name.size() < step.size()) {
      std::size_t index = 0;
      const char* const digits = step.data() + name.size() + 1;
      const char* const end = step.data() + step.size();
      const auto [stop, error] = std::from_chars(digits, end, index);
      if (error != std::errc{} || stop + 1 != end || *stop != ']' ||
          at.field->shape == FieldShape::single) {
        throw InputError(path, fmt::format("'{}' is no element in {}", step, type_.name));
      }
      if (index >= at.value->parts.size()) {
        grow(path, at, index + 1);
      }
      at = {at.field, &at.value->parts[index], true};
    }
  }
  return at;
}

void MessageBuilder::grow(std::string_view path, Target& whole, std::size_t length) {
  const Field& field = *whole.field;
  const bool fits = field.shape == FieldShape::array
                        ? length == whole.value->parts.size()
                        : field.shape == FieldShape::sequence && length <= field.size;
  if (!fits || whole.element) {
    throw InputError(path, fmt::format("can't have {} elements", length));
  }
  whole.value->parts.resize(length, zero_of(field, true));
}

void MessageBuilder::set(std::string_view path, double value) {
  const Target target = find(path);
  require_number(path, *target.field, value);
  if (target.field->shape != FieldShape::single && !target.element) {
    throw InputError(path, "holds several numbers");
  }
  target.value->number = value;
}

void MessageBuilder::set(std::string_view path, std::string_view text) {
  const Target target = find(path);
  if (target.field->kind != FieldKind::string ||
      (target.field->shape != FieldShape::single && !target.element)) {
    throw InputError(path, "isn't a text in this type");
  }
  if (text.size() > target.field->string_bound) {
    throw InputError(path, fmt::format("has {} bytes; its type allows {}", text.size(),
                                       target.field->string_bound));
  }
  target.value->text = text;
}

void MessageBuilder::set(std::string_view path, std::span<const double> values) {
  Target target = find(path);
  grow(path, target, values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    require_number(path, *target.field, values[i]);
    target.value->parts[i].number = values[i];
  }
}

void MessageBuilder::resize(std::string_view path, std::size_t length) {
  Target target = find(path);
  grow(path, target, length);
}

std::span<const std::byte> MessageBuilder::bytes() {
  bytes_.assign(kLittleEndianCdr.begin(), kLittleEndianCdr.end());
  write(type_.root, root_, false);
  return bytes_;
}

void MessageBuilder::write(const Field& field, const Value& value, bool element) {
  if (!element && field.shape != FieldShape::single) {
    if (field.shape == FieldShape::sequence) {
      write_length(value.parts.size());
    }
    for (const Value& part : value.parts) {
      write(field, part, true);
    }
  } else if (field.kind == FieldKind::structure) {
    for (std::size_t i = 0; i < field.fields.size(); ++i) {
      write(field.fields[i], value.parts[i], false);
    }
    if (field.fields.empty()) {
      write_number(FieldKind::uint8, 0.0);  // rosidl's dummy member
    }
  } else if (field.kind == FieldKind::string) {
    write_length(value.text.size() + 1);
    const auto text = std::as_bytes(std::span(value.text));
    bytes_.insert(bytes_.end(), text.begin(), text.end());
    bytes_.push_back(std::byte{0});
  } else {
    write_number(field.kind, value.number);
  }
}

// Alignment counts from behind the encapsulation.
void MessageBuilder::write_number(FieldKind kind, double value) {
  const std::size_t size = wire::bytes_of(kind);
  const std::size_t position = bytes_.size() - kLittleEndianCdr.size();
  const std::size_t at = bytes_.size() + (size - position % size) % size;
  bytes_.resize(at + size);
  wire::store_number(std::span(bytes_).subspan(at), kind, value);
}

void MessageBuilder::write_length(std::size_t length) {
  write_number(FieldKind::uint32, static_cast<double>(length));
}

}  // namespace kelpie::bag
