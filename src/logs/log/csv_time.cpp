// SPDX-License-Identifier: Apache-2.0
#include "log/csv_time.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cmath>

#include "core/seconds.hpp"
#include "core/text.hpp"

namespace kelpie::log {
namespace {

constexpr std::int64_t kDayNs = 86'400 * kSecondNs;

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
  // A number of as many digits as there are, up to `most`.
  std::optional<int> short_number(int most) {
    const auto digits = std::ranges::find_if_not(rest_, is_stamp_digit) - rest_.begin();
    return digits > 0 && digits < 5 ? number(static_cast<std::size_t>(digits), most) : std::nullopt;
  }
  // "Jan", "january".
  std::optional<int> month() {
    constexpr std::string_view kMonths = "janfebmaraprmayjunjulaugsepoctnovdec";
    std::string word;
    for (; !rest_.empty() && std::isalpha(static_cast<unsigned char>(rest_.front())) != 0;
         rest_.remove_prefix(1)) {
      word += static_cast<char>(std::tolower(static_cast<unsigned char>(rest_.front())));
    }
    const std::size_t place = kMonths.find(word.substr(0, 3));
    return word.size() > 2 && place != std::string_view::npos && place % 3 == 0
               ? std::optional(static_cast<int>(place / 3) + 1)
               : std::nullopt;
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
  bool begins_with_letter() const {
    return !rest_.empty() && std::isalpha(static_cast<unsigned char>(rest_.front())) != 0;
  }

 private:
  std::string_view rest_;
};

// How a date is written.
enum class DateForm { iso, day_first, month_first };

std::optional<std::int64_t> days_s(int year, int month, int day) {
  const std::chrono::year_month_day date(std::chrono::year(year),
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day)));
  if (year < 1970 || !date.ok()) {
    return std::nullopt;
  }
  return std::int64_t{86'400} * std::chrono::sys_days(date).time_since_epoch().count();
}

std::optional<std::int64_t> date_s(StampText& text, DateForm form) {
  constexpr std::string_view kMarks = ".-/, ";
  if (form == DateForm::iso) {
    const auto year = text.number(4, 2199);
    const auto month = year && text.skip("-") ? text.number(2, 12) : std::nullopt;
    const auto day = month && text.skip("-") ? text.number(2, 31) : std::nullopt;
    return day ? days_s(*year, *month, *day) : std::nullopt;
  }
  const auto month = [&] {
    return text.begins_with_letter() ? text.month() : text.short_number(12);
  };
  const bool is_day_first = form == DateForm::day_first;
  const auto first = is_day_first ? text.short_number(31) : month();
  const bool goes_on = first && text.skip(kMarks);
  const auto second = !goes_on ? std::nullopt : is_day_first ? month() : text.short_number(31);
  const bool has_year = second && text.skip(kMarks);
  text.skip(" ");
  const auto year = has_year ? text.number(4, 2199) : std::nullopt;
  return !year          ? std::nullopt
         : is_day_first ? days_s(*year, *second, *first)
                        : days_s(*year, *first, *second);
}

std::optional<std::int64_t> time_of_day_ns(StampText& text, bool is_short) {
  const auto hours = is_short ? text.short_number(99) : text.number(2, 23);
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
  constexpr std::int64_t kHalfDayNs = kDayNs / 2;
  const bool is_past_noon = text.skip_word(" PM") || text.skip_word(" pm");
  if (is_past_noon || text.skip_word(" AM") || text.skip_word(" am")) {
    time_ns = time_ns % kHalfDayNs + (is_past_noon ? kHalfDayNs : 0);
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

namespace {

std::optional<std::int64_t> stamp_ns(std::string_view text, DateForm form) {
  StampText rest(text);
  const auto date = date_s(rest, form);
  if (!date || rest.is_empty()) {
    return date ? std::optional(*date * kSecondNs) : std::nullopt;
  }
  const bool is_iso = form == DateForm::iso;
  const bool has_time = rest.skip(is_iso ? " Tt" : " Tt,");
  const auto time_of_day = has_time ? time_of_day_ns(rest, !is_iso) : std::nullopt;
  const auto zone = time_of_day ? zone_ns(rest) : std::nullopt;
  return zone ? std::optional(*date * kSecondNs + *time_of_day - *zone) : std::nullopt;
}

// "13:07:00.2", "1 days 00:00:01".
std::optional<std::int64_t> clock_ns(std::string_view text) {
  StampText rest(text);
  std::int64_t days = 0;
  if (const std::size_t word = text.find(" day"); word != std::string_view::npos) {
    const auto count = rest.short_number(9999);
    rest = StampText(trimmed(text.substr(std::min(text.find(' ', word + 1), text.size()))));
    if (!count) {
      return std::nullopt;
    }
    days = *count;
  }
  const auto time_ns = time_of_day_ns(rest, true);
  return time_ns && rest.is_empty() ? std::optional(*time_ns + days * kDayNs) : std::nullopt;
}

// "0.2 sec".
std::optional<std::int64_t> duration_ns(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, double>, 18> kUnits{{{"s", 1e9},
                                                                        {"sec", 1e9},
                                                                        {"secs", 1e9},
                                                                        {"second", 1e9},
                                                                        {"seconds", 1e9},
                                                                        {"ms", 1e6},
                                                                        {"msec", 1e6},
                                                                        {"us", 1e3},
                                                                        {"min", 6e10},
                                                                        {"mins", 6e10},
                                                                        {"minute", 6e10},
                                                                        {"minutes", 6e10},
                                                                        {"hr", 3.6e12},
                                                                        {"hrs", 3.6e12},
                                                                        {"hour", 3.6e12},
                                                                        {"hours", 3.6e12},
                                                                        {"day", 8.64e13},
                                                                        {"days", 8.64e13}}};
  const std::size_t blank = text.rfind(' ');
  double number = 0.0;
  if (blank == std::string_view::npos || !parse_number(trimmed(text.substr(0, blank)), number)) {
    return std::nullopt;
  }
  const auto found =
      std::ranges::find(kUnits, text.substr(blank + 1), &decltype(kUnits)::value_type::first);
  constexpr double kMost = 9e18;  // ns that fit
  return found == kUnits.end() || std::abs(number * found->second) > kMost
             ? std::nullopt
             : std::optional(std::llround(number * found->second));
}

using Words = std::span<const std::pair<std::size_t, std::string>>;

template <typename Parse>
std::vector<std::int64_t> times_by(Words words, const Parse& parse) {
  std::vector<std::int64_t> times_ns;
  for (const auto& [row, word] : words) {
    const std::optional<std::int64_t> time_ns = parse(word);
    if (!time_ns) {
      break;
    }
    times_ns.push_back(*time_ns);
  }
  return times_ns;
}

void pass_midnights(std::vector<std::int64_t>& times_ns) {
  std::int64_t days_ns = 0;
  std::int64_t before = 0;
  for (std::int64_t& time : times_ns) {
    days_ns += time < before - kDayNs / 2 ? kDayNs : 0;
    before = time;
    time += days_ns;
  }
}

}  // namespace

std::optional<std::int64_t> parse_stamp(std::string_view text) {
  return stamp_ns(text, DateForm::iso);
}

std::vector<std::int64_t> times_of_words(Words words) {
  const auto by_date = [&](DateForm form) {
    return times_by(words, [&](std::string_view word) { return stamp_ns(word, form); });
  };
  std::vector<std::int64_t> best = by_date(DateForm::iso);
  const std::vector<std::int64_t> by_day = by_date(DateForm::day_first);
  const std::vector<std::int64_t> by_month = by_date(DateForm::month_first);
  const bool is_unclear = by_day.size() == by_month.size() && by_day != by_month;
  std::vector<std::int64_t> clock = times_by(words, clock_ns);
  pass_midnights(clock);
  for (const std::vector<std::int64_t>& one : {is_unclear ? std::vector<std::int64_t>{}
                                               : by_day.size() > by_month.size() ? by_day
                                                                                 : by_month,
                                               clock, times_by(words, duration_ns)}) {
    best = one.size() > best.size() ? one : best;
  }
  return best;
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
