// SPDX-License-Identifier: Apache-2.0
#include "chart/wording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "core/text.hpp"

namespace kelpie::chart {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD
constexpr std::string_view kMinus = "\xE2\x88\x92";        // U+2212
constexpr std::string_view kAbsent = "–";

bool continues(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U;
}

// Marks and overrides of direction: U+061C, U+200E, U+200F, U+202A to U+202E, U+2066 to U+2069. In
// a name they would turn the words around it.
std::size_t turning_mark(std::string_view rest) {
  if (rest.starts_with("\xD8\x9C")) {
    return 2;
  }
  const bool general = rest.size() >= 3 && rest.starts_with("\xE2\x80");
  const auto last = rest.size() >= 3 ? static_cast<unsigned char>(rest[2]) : 0U;
  const bool turns = general ? last == 0x8E || last == 0x8F || (last >= 0xAA && last <= 0xAE)
                             : rest.starts_with("\xE2\x81") && last >= 0xA6 && last <= 0xA9;
  return turns ? 3 : 0;
}

// The JSON library's writer already knows how to repair UTF-8.
std::string repaired(std::string_view text) {
  using nlohmann::json;
  const std::string quoted = json(text).dump(-1, ' ', false, json::error_handler_t::replace);
  return json::parse(quoted).get<std::string>();
}

std::string with_minus(const std::string& number) {
  return number.front() == '-' ? fmt::format("{}{}", kMinus, number.substr(1)) : number;
}

}  // namespace

std::string safe_text(std::string_view text) {
  const std::string whole = repaired(text);
  const auto byte = [&](std::size_t i) {
    return i < whole.size() ? static_cast<unsigned char>(whole[i]) : 0U;
  };
  std::string safe;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    const bool of_two_bytes = byte(i) == 0xC2 && byte(i + 1) < 0xA0;  // U+0080 to U+009F
    const std::size_t mark = turning_mark(std::string_view(whole).substr(i));
    if (of_two_bytes || byte(i) < 0x20 || byte(i) == 0x7F || mark > 0) {
      safe += kReplacement;
      i += of_two_bytes ? 1 : mark > 0 ? mark - 1 : 0;
    } else {
      safe += whole[i];
    }
  }
  return safe;
}

std::size_t code_points(std::string_view text) {
  std::size_t count = 0;
  for (const char byte : text) {
    count += continues(byte) ? 0U : 1U;
  }
  return count;
}

std::string shortened(std::string_view text, std::size_t most) {
  std::string whole = safe_text(text);
  if (code_points(whole) <= most) {
    return whole;
  }
  std::size_t end = 0;
  for (std::size_t kept = 0; kept + 1 < most; ++kept) {
    for (++end; continues(whole[end]); ++end) {
    }
  }
  return fmt::format("{}…", whole.substr(0, end));
}

std::string file_names(std::string_view paths) {
  constexpr std::string_view kBetween = ", ";
  std::string names;
  for (std::size_t begin = 0; begin <= paths.size();) {
    const std::size_t end = std::min(paths.find(kBetween, begin), paths.size());
    std::string_view path = paths.substr(begin, end - begin);
    while (path.size() > 1 && path.ends_with('/')) {
      path.remove_suffix(1);
    }
    names += names.empty() ? "" : kBetween;
    names += path.substr(std::min(path.rfind('/') + 1, path.size() - 1));
    begin = end + kBetween.size();
  }
  return names;
}

std::string escape_markup(std::string_view text) {
  std::string escaped;
  for (const char letter : safe_text(text)) {
    switch (letter) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += letter;
    }
  }
  return escaped;
}

std::string grouped(std::int64_t value) {
  std::string digits = fmt::format("{}", value);
  const std::size_t first = value < 0 ? 1 : 0;
  for (std::size_t end = digits.size(); end > first + 3;) {
    end -= 3;
    digits.insert(end, 1, ',');
  }
  return with_minus(digits);
}

std::string decimal(double value) {
  if (!std::isfinite(value)) {
    return std::string(kAbsent);
  }
  const std::string text =
      std::abs(value) < 10.0 ? fmt::format("{:.3f}", value) : fmt::format("{:.3g}", value);
  return text == "-0.000" ? "0.000" : with_minus(text);
}

std::string significant(double value) {
  if (!std::isfinite(value)) {
    return std::string(kAbsent);
  }
  std::string text = fmt::format("{:#.4g}", value);
  if (text.ends_with('.')) {
    text.pop_back();
  }
  return with_minus(text);
}

std::string time_text(double time_s) {
  if (!std::isfinite(time_s)) {
    return std::string(kAbsent);
  }
  std::string text = fmt::format("{:.2f}", time_s);
  text.erase(text.find_last_not_of('0') + 1);
  text.erase(text.find_last_not_of('.') + 1);
  return text;
}

std::string duration(double microseconds) {
  if (!std::isfinite(microseconds)) {
    return std::string(kAbsent);
  }
  // The limits round to the next unit: 999.7 µs is 1.0 ms, not 1000 µs.
  const bool seconds = microseconds >= 999.5e3;
  const bool milliseconds = !seconds && microseconds >= 999.5;
  const double value = microseconds / (seconds ? 1e6 : milliseconds ? 1e3 : 1.0);
  return fmt::format("{:.{}f} {}", value, value < 10.0 ? 1 : 0,
                     seconds        ? "s"
                     : milliseconds ? "ms"
                                    : "µs");
}

std::string list_text(const std::vector<std::string>& parts) {
  const std::span<const std::string> all(parts);
  return parts.size() < 2 ? join_text(all, "")
                          : join_text(all.first(all.size() - 1), ", ") + " and " + parts.back();
}

namespace {

constexpr std::array<std::string_view, 10> kRaised{"⁰", "", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};

bool is_digit(char letter) {
  return letter >= '0' && letter <= '9';
}

// "m^2/(rad s)" as "m²/(rad s)".
std::string with_raised_digits(std::string_view unit) {
  std::string text;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    const bool ends = i + 2 >= unit.size() || (!is_digit(unit[i + 2]) && unit[i + 2] != '.');
    if (unit[i] == '^' && i + 1 < unit.size() && is_digit(unit[i + 1]) && ends) {
      text += kRaised[static_cast<std::size_t>(unit[++i] - '0')];
    } else {
      text += unit[i];
    }
  }
  return text;
}

}  // namespace

std::string unit_text(std::string_view unit) {
  constexpr std::string_view kSquared = ")^2";
  const std::size_t open = unit.find('(');
  if (open != std::string_view::npos && unit.ends_with(kSquared)) {
    const std::string_view inside = unit.substr(open + 1, unit.size() - kSquared.size() - open - 1);
    return unit_text(unit.substr(0, open)) + "(" + unit_text(inside) + ")²";
  }
  std::string above;
  std::string below;
  bool several = false;
  for (const std::string& power : split_text(std::string(unit), ' ')) {
    const std::size_t sign = std::min(power.find('^'), power.size());
    std::string_view exponent = std::string_view(power).substr(std::min(sign + 1, power.size()));
    const bool divides = exponent.starts_with('-');
    exponent.remove_prefix(divides ? 1 : 0);
    const bool is_raised = exponent.size() == 1 && is_digit(exponent[0]);
    if (sign == 0 || (sign < power.size() && !is_raised) || power.find('/') != std::string::npos) {
      return with_raised_digits(unit);
    }
    std::string& side = divides ? below : above;
    several = several || (divides && !below.empty());
    side += (side.empty() ? "" : "·") + power.substr(0, sign);
    side += is_raised ? kRaised[static_cast<std::size_t>(exponent[0] - '0')] : "";
  }
  const std::string under = several ? "(" + below + ")" : below;
  return below.empty() ? above : (above.empty() ? "1" : above) + "/" + under;
}

}  // namespace kelpie::chart
