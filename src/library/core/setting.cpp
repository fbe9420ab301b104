// SPDX-License-Identifier: Apache-2.0
#include "kelpie/core/setting.hpp"

#include <array>
#include <charconv>
#include <vector>

#include "core/text.hpp"

namespace kelpie {
namespace {

Place field(std::string_view name) {
  return {.file = {}, .line = 0, .field = std::string(name)};
}

}  // namespace

std::string number_text(double value) {
  std::array<char, 32> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end};
}

double number_setting(std::string_view name, std::string_view text) {
  double value = 0.0;
  if (!parse_number(trimmed(text), value)) {
    throw InputError(field(name), "'" + printable(text) + "' is not a number");
  }
  return value;
}

int choice_setting(std::string_view name, std::string_view text,
                   std::span<const std::string_view> choices) {
  const std::vector<std::string> names(choices.begin(), choices.end());
  return static_cast<int>(require_name(name, trimmed(text), "choice", names));
}

std::string Range::text() const {
  if (std::isinf(low) && std::isinf(high)) {
    return "any finite number";
  }
  if (std::isinf(high)) {
    return (open ? "> " : ">= ") + number_text(low);
  }
  return open ? "more than " + number_text(low) + ", up to " + number_text(high)
              : number_text(low) + " to " + number_text(high);
}

void require_range(std::string_view field, double value, const Range& range,
                   const std::string& unit) {
  if (!range.holds(value)) {
    throw InputError(field, number_text(value) + " is out of range; it has to be " + range.text() +
                                (unit.empty() ? "" : " " + unit));
  }
}

std::string IdleCondition::text(std::string_view value) const {
  return "with " + std::string(with) + (value.empty() ? "" : " = " + std::string(value));
}

}  // namespace kelpie
