// SPDX-License-Identifier: Apache-2.0
#include "log/csv_time.hpp"

#include <algorithm>
#include <chrono>

#include "core/seconds.hpp"

namespace kelpie::log {
namespace {

bool is_stamp_digit(char c) {
  return c >= '0' && c <= '9';
}

// Takes a text apart from its beginning.
class StampText {
 public:
  explicit StampText(std::string_view text) : rest_(text) {}

  bool is_empty() const { return rest_.empty(); }
  bool skip(std::string_view one_of) {
    if (rest_.empty() || one_of.find(rest_.front()) == std::string_view::npos) {
      return false;
    }
    rest_.remove_prefix(1);
    return true;
  }
  bool skip_word(std::string_view word) {
    const bool is_there = rest_ == word;
    rest_.remove_prefix(is_there ? word.size() : 0);
    return is_there;
  }
  // A number of so many digits up to `most`; else it isn't there.
  std::optional<int> number(std::size_t digits, int most) {
    if (rest_.size() < digits || !std::ranges::all_of(rest_.substr(0, digits), is_stamp_digit)) {
      return std::nullopt;
    }
    int value = 0;
    for (; digits > 0; --digits, rest_.remove_prefix(1)) {
      value = 10 * value + (rest_.front() - '0');
    }
    return value <= most ? std::optional(value) : std::nullopt;
  }
  // As many digits as there are, as a fraction in ns; the tenth and further ones are cut off.
  std::optional<std::int64_t> fraction_ns() {
    if (rest_.empty() || !is_stamp_digit(rest_.front())) {
      return std::nullopt;
    }
    std::int64_t value = 0;
    std::int64_t unit = kSecondNs;
    for (; !rest_.empty() && is_stamp_digit(rest_.front()); rest_.remove_prefix(1)) {
      unit /= 10;
      value += unit * (rest_.front() - '0');
    }
    return value;
  }
  bool begins_with(char c) const { return rest_.starts_with(c); }

 private:
  std::string_view rest_;
};

std::optional<std::int64_t> date_s(StampText& text) {
  const auto year = text.number(4, 2199);
  const bool has_month = year && *year >= 1970 && text.skip("-");
  const auto month = has_month ? text.number(2, 12) : std::nullopt;
  const auto day = month && text.skip("-") ? text.number(2, 31) : std::nullopt;
  if (!day) {
    return std::nullopt;
  }
  const std::chrono::year_month_day date(std::chrono::year(*year),
                                         std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day)));
  if (!date.ok()) {
    return std::nullopt;
  }
  return std::int64_t{86'400} * std::chrono::sys_days(date).time_since_epoch().count();
}

std::optional<std::int64_t> time_of_day_ns(StampText& text) {
  const auto hours = text.number(2, 23);
  const auto minutes = hours && text.skip(":") ? text.number(2, 59) : std::nullopt;
  if (!minutes) {
    return std::nullopt;
  }
  std::int64_t time_ns = (*hours * std::int64_t{3'600} + *minutes * std::int64_t{60}) * kSecondNs;
  if (text.skip(":")) {
    const auto seconds = text.number(2, 60);
    const auto fraction =
        seconds && text.skip(".,") ? text.fraction_ns() : std::optional<std::int64_t>(0);
    if (!seconds || !fraction) {
      return std::nullopt;
    }
    time_ns += *seconds * kSecondNs + *fraction;
  }
  return time_ns;
}

// How far it is ahead of UTC.
std::optional<std::int64_t> zone_ns(StampText& text) {
  text.skip(" ");
  if (text.is_empty() || text.skip_word("Z") || text.skip_word("z") || text.skip_word("UTC")) {
    return 0;
  }
  const std::int64_t sign = text.begins_with('-') ? -1 : 1;
  const auto hours = text.skip("+-") ? text.number(2, 15) : std::nullopt;
  text.skip(":");
  const auto minutes = text.is_empty() ? std::optional(0) : text.number(2, 59);
  if (!hours || !minutes || !text.is_empty()) {
    return std::nullopt;
  }
  return sign * (*hours * std::int64_t{3'600} + *minutes * std::int64_t{60}) * kSecondNs;
}

}  // namespace

std::optional<std::int64_t> parse_stamp(std::string_view text) {
  StampText rest(text);
  const auto date = date_s(rest);
  if (!date || rest.is_empty()) {
    return date ? std::optional(*date * kSecondNs) : std::nullopt;
  }
  const auto time_of_day = rest.skip(" Tt") ? time_of_day_ns(rest) : std::nullopt;
  const auto zone = time_of_day ? zone_ns(rest) : std::nullopt;
  return zone ? std::optional(*date * kSecondNs + *time_of_day - *zone) : std::nullopt;
}

bool is_unclear_stamp(std::string_view text) {
  std::size_t at = 0;
  const auto pass_digits = [&](std::size_t most) {
    const std::size_t first = at;
    while (at < text.size() && at - first < most && is_stamp_digit(text[at])) {
      ++at;
    }
    return at > first;
  };
  const auto pass_mark = [&] {
    return at < text.size() && std::string_view("./-").find(text[at++]) != std::string_view::npos;
  };
  return pass_digits(2) && pass_mark() && pass_digits(2) && pass_mark() && pass_digits(4) &&
         (at == text.size() || text[at] == ' ' || text[at] == 'T' || text[at] == ',');
}

}  // namespace kelpie::log
