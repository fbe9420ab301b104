// SPDX-License-Identifier: Apache-2.0
#include "bag/message_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "core/text.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::bag {
bool is_identifier(std::string_view word) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  return !word.empty() && is_letter(word.front()) && std::ranges::all_of(word, [&](char c) {
    return is_letter(c) || (c >= '0' && c <= '9') || c == '_';
  });
}

namespace {

constexpr std::string_view kBlanks = " \t\r";

std::string_view without_comment(std::string_view line) {
  return trimmed(line.substr(0, line.find_first_of("#\r")));
}

// One line of a .msg text.
class LineParser {
 public:
  LineParser(const std::string& type, std::size_t number, std::string_view line)
      : type_(type), number_(number), line_(line) {}

  // False for a constant.
  bool parse(FieldLine& field) const {
    const std::size_t space = line_.find_first_of(kBlanks);
    if (space == std::string_view::npos) {
      refuse("a type and a name are due");
    }
    const std::string_view rest = trimmed(line_.substr(space));
    const std::size_t end = std::min(rest.find_first_of(" \t="), rest.size());
    field.name = rest.substr(0, end);
    if (!is_identifier(field.name)) {
      refuse("after the type a name is due");
    }
    parse_type(line_.substr(0, space), field);
    return !trimmed(rest.substr(end)).starts_with('=');
  }

 private:
  [[noreturn]] void refuse(const std::string& message) const {
    throw InputError(fmt::format("{}, line {}", type_, number_),
                     fmt::format("'{}' is no field: {}", line_.substr(0, 80), message));
  }

  void parse_type(std::string_view word, FieldLine& field) const {
    if (word.ends_with(']')) {
      const std::size_t open = std::min(word.rfind('['), word.size());
      parse_shape(word.substr(open), field);
      word = word.substr(0, open);
    }
    if (const std::size_t bound = word.find("<="); bound != std::string_view::npos) {
      field.string_bound = number(word.substr(bound + 2));
      word = word.substr(0, bound);
    }
    const std::string_view last = word.substr(word.rfind('/') + 1);
    if (!is_identifier(last)) {
      refuse("its type isn't one");
    }
    field.type = word;
  }

  void parse_shape(std::string_view brackets, FieldLine& field) const {
    if (brackets.size() < 2) {
      refuse("a bracket is missing");
    }
    const std::string_view inside = trimmed(brackets.substr(1, brackets.size() - 2));
    const bool bounded = inside.starts_with("<=");
    field.shape = inside.empty() || bounded ? FieldShape::sequence : FieldShape::array;
    if (!inside.empty()) {
      field.size = number(bounded ? inside.substr(2) : inside);
    }
  }

  std::uint32_t number(std::string_view digits) const {
    std::uint32_t value = 0;
    const char* const end = digits.data() + digits.size();
    const auto [stop, error] = std::from_chars(digits.data(), end, value);
    if (error != std::errc{} || stop != end || value == 0 || value == Field::kUnbounded) {
      refuse("a size is a whole number above 0");
    }
    return value;
  }

  const std::string& type_;
  std::size_t number_;
  std::string_view line_;
};

}  // namespace

std::vector<FieldLine> parse_fields(const std::string& type, std::string_view text) {
  std::vector<FieldLine> fields;
  std::size_t number = 0;
  for (std::size_t first = 0; first < text.size();) {
    const std::size_t length = std::min(text.find('\n', first), text.size()) - first;
    const std::string_view line = without_comment(text.substr(first, length));
    first += length + 1;
    ++number;
    FieldLine field;
    if (!line.empty() && LineParser(type, number, line).parse(field)) {
      fields.push_back(std::move(field));
    }
  }
  return fields;
}

std::map<std::string, std::string> split_sections(const std::string& name, std::string_view text) {
  constexpr std::string_view kHead = "MSG:";
  std::map<std::string, std::string> sections;
  std::string* section = &sections[short_type_name(name)];
  for (std::size_t first = 0; first < text.size();) {
    const std::size_t length = std::min(text.find('\n', first), text.size()) - first;
    const std::string_view line = trimmed(text.substr(first, length));
    first += length + 1;
    if (line.starts_with(kHead)) {
      section = &sections[short_type_name(std::string(without_comment(line.substr(kHead.size()))))];
    } else {
      // A rule of equals signs stands between sections; an empty line keeps line numbers right.
      section->append(line.starts_with("====") ? std::string_view() : line).push_back('\n');
    }
  }
  return sections;
}

std::string short_type_name(const std::string& name) {
  const std::vector<std::string> parts = split_text(name, '/');
  const bool has_folder = parts.size() == 3 && parts[1] == "msg";
  if ((parts.size() != 2 && !has_folder) || !is_identifier(parts.front()) ||
      !is_identifier(parts.back())) {
    throw InputError(name, "is not the name of a message type; one reads as nav_msgs/msg/Odometry");
  }
  return parts.front() + "/" + parts.back();
}

}  // namespace kelpie::bag
