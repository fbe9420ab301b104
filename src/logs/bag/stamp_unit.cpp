// SPDX-License-Identifier: Apache-2.0
#include "bag/stamp_unit.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "bag/tuning.hpp"

namespace kelpie::bag {
namespace {

constexpr StampUnit kMilliseconds{"ms", 1e-3};
constexpr StampUnit kMicroseconds{"us", 1e-6};
constexpr StampUnit kNanoseconds{"ns", 1e-9};

constexpr std::array kEndings = std::to_array<std::pair<std::string_view, StampUnit>>({
    {"_s", {"s"}},
    {"_sec", {"s"}},
    {"_ms", kMilliseconds},
    {"_msec", kMilliseconds},
    {"_us", kMicroseconds},
    {"_usec", kMicroseconds},
    {"_ns", kNanoseconds},
    {"_nsec", kNanoseconds},
});

std::string in_small_letters(std::string_view name) {
  std::string text(name);
  std::ranges::transform(text, text.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return text;
}

const std::pair<std::string_view, StampUnit>* ending_of(std::string_view name) {
  const auto* const found = std::ranges::find_if(kEndings, [&](const auto& known) {
    return name.ends_with(known.first) && name.size() > known.first.size();
  });
  return found == kEndings.end() ? nullptr : found;
}

}  // namespace

std::optional<StampUnit> unit_in_name(std::string_view name) {
  const auto* const ending = ending_of(in_small_letters(name));
  return ending == nullptr ? std::nullopt : std::optional(ending->second);
}

std::string without_time_unit(std::string_view name) {
  std::string text = in_small_letters(name);
  if (const auto* const ending = ending_of(text)) {
    text.resize(text.size() - ending->first.size());
  }
  return text;
}

std::optional<StampUnit> unit_by_size(double first, double last, std::size_t steps) {
  constexpr std::array<std::pair<double, StampUnit>, 3> kSince1970{
      {{1e17, kNanoseconds}, {1e14, kMicroseconds}, {1e11, kMilliseconds}}};
  for (const auto& [least, unit] : kSince1970) {
    if (first > least) {
      return unit;
    }
  }
  struct Days {
    double first, last, zero;
  };
  constexpr std::array<Days, 2> kDays{{{kTuning.first_datenum, kTuning.last_datenum, 719'529.0},
                                       {kTuning.first_day, kTuning.last_day, 25'569.0}}};
  for (const Days& known : kDays) {
    // Nobody samples faster than each 20 µs for days.
    const bool is_short = (last - first) < kTuning.longest_day_step * static_cast<double>(steps);
    if (first > known.first && last < known.last && is_short && last > first) {
      return StampUnit{"d", 86'400.0, known.zero};
    }
  }
  return std::nullopt;
}

}  // namespace kelpie::bag
