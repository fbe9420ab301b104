// SPDX-License-Identifier: Apache-2.0
#include "health/card.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <regex>
#include <utility>

#include "core/quantile.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::health {
namespace {

constexpr double kMinutesPerDay = 1440.0;

void sort_by_day(HealthTable& table) {
  std::vector<std::size_t> order(table.episodes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return table.episodes[i].day; });
  std::vector<Episode> episodes;
  std::vector<std::vector<Estimate>> estimates;
  for (const std::size_t i : order) {
    episodes.push_back(std::move(table.episodes[i]));
    estimates.push_back(std::move(table.estimates[i]));
  }
  table.episodes = std::move(episodes);
  table.estimates = std::move(estimates);
}

// Days since 1970 of the parts of a date; NaN for a day that no calendar has.
double day_from(const std::smatch& parts) {
  const auto number = [&](std::size_t i) {
    return parts[i].matched && parts[i].length() > 0 ? std::stoi(parts[i]) : 0;
  };
  const std::chrono::year_month_day date(std::chrono::year(number(1)),
                                         std::chrono::month(static_cast<unsigned>(number(2))),
                                         std::chrono::day(static_cast<unsigned>(number(3))));
  if (!date.ok() || number(4) > 23 || number(5) > 59) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count()) +
         (60.0 * number(4) + number(5)) / kMinutesPerDay;
}

// Per cent of the factor before, or of 1 where the factor before may be 0 (a dead thruster).
double percent_of(const Change& change) {
  const Estimate& before = change.course.before;
  return 100.0 / (before.value > kNormal90 * before.error ? before.value : 1.0);
}

std::string signed_text(double value, double error) {
  return (value < 0.0 ? "" : "+") + rounded(value, error);
}

}  // namespace

HealthCard make_card(std::string vehicle, bool is_dated, HealthTable table,
                     const std::vector<Baseline>& baselines) {
  HealthCard card{.vehicle = std::move(vehicle),
                  .is_dated = is_dated,
                  .table = std::move(table),
                  .baselines = {},
                  .changes = {}};
  sort_by_day(card.table);
  const double first = card.table.episodes.empty() ? 0.0 : card.table.episodes.front().day;
  card.baselines.push_back({"deployment", first});
  for (const Baseline& baseline : baselines) {
    if (baseline.name == "deployment") {
      card.baselines.front() = baseline;
    } else {
      card.baselines.push_back(baseline);
    }
  }
  for (std::size_t quantity = 0; quantity < card.table.quantities.size(); ++quantity) {
    const Series series = series_of(card.table, quantity);
    for (std::size_t baseline = 0; baseline < card.baselines.size(); ++baseline) {
      card.changes.push_back(
          {quantity, baseline, judge(since(series, card.baselines[baseline].day))});
    }
  }
  return card;
}

Series series_of(const HealthTable& table, std::size_t quantity) {
  Series series;
  for (std::size_t i = 0; i < table.episodes.size(); ++i) {
    const Estimate& estimate = table.estimates[i][quantity];
    if (std::isfinite(estimate.value) && estimate.error > 0.0 && std::isfinite(estimate.error)) {
      series.days.push_back(table.episodes[i].day);
      series.estimates.push_back(estimate);
    }
  }
  return series;
}

bool is_found(const Course& course) {
  return course.kind != CourseKind::unknown && course.kind != CourseKind::constant;
}

std::string day_text(const HealthCard& card, double day) {
  if (!card.is_dated) {
    const auto at = std::ranges::find_if(card.table.episodes,
                                         [&](const Episode& one) { return one.day >= day; });
    return at != card.table.episodes.end() ? at->name : card.table.episodes.back().name;
  }
  constexpr std::array<const char*, 12> kMonths{"January",   "February", "March",    "April",
                                                "May",       "June",     "July",     "August",
                                                "September", "October",  "November", "December"};
  const std::chrono::sys_days days{std::chrono::days(static_cast<int>(std::floor(day)))};
  const std::chrono::year_month_day date(days);
  return fmt::format("{} {} {}", static_cast<unsigned>(date.day()),
                     kMonths.at(static_cast<unsigned>(date.month()) - 1),
                     static_cast<int>(date.year()));
}

std::string rounded(double value, double error) {
  const int places =
      error > 0.0 ? std::clamp(1 - static_cast<int>(std::floor(std::log10(error))), 0, 9) : 2;
  return fmt::format("{}{:.{}f}", value < 0.0 ? "−" : "", std::abs(value), places);
}

std::string change_size(const HealthCard& card, const Change& change) {
  const Quantity& quantity = card.table.quantities[change.quantity];
  const Estimate& size = change.course.change;
  const double half = kNormal90 * size.error;
  if (quantity.unit.empty()) {
    const double percent = percent_of(change);
    return fmt::format("{} % ± {} %", signed_text(percent * size.value, percent * half),
                       rounded(percent * half, percent * half));
  }
  return fmt::format("{} ± {} {}", signed_text(size.value, half), rounded(half, half),
                     quantity.unit);
}

std::string change_text(const HealthCard& card, const Change& change) {
  const Quantity& quantity = card.table.quantities[change.quantity];
  const Course& course = change.course;
  if (course.kind == CourseKind::unknown) {
    return quantity.name + ": too few episodes";
  }
  if (course.kind == CourseKind::constant) {
    return fmt::format("{}: no change ({})", quantity.name, change_size(card, change));
  }
  std::string text = fmt::format("{} {} since {}", quantity.name, change_size(card, change),
                                 day_text(card, course.since_day));
  if (course.kind == CourseKind::drift) {
    const double half = kNormal90 * course.rate.error;
    const bool is_factor = quantity.unit.empty();
    const double scale = is_factor ? percent_of(change) : 1.0;
    text += fmt::format(", {} {} a day", rounded(scale * course.rate.value, scale * half),
                        is_factor ? "%" : quantity.unit);
  } else if (course.kind == CourseKind::step) {
    text += ", at once";
  } else {
    text += ", whether slowly or at once is not told";
  }
  return text;
}

double day_of(const std::string& date, const std::string& field) {
  static const std::regex kDate(R"((\d{4})-(\d{2})-(\d{2})(?:[T ](\d{2}):?(\d{2}).*)?)");
  std::smatch parts;
  const double day = std::regex_match(date, parts, kDate) ? day_from(parts) : NAN;
  require(std::isfinite(day), field, "'" + date + "' is no date as in 2026-03-03");
  return day;
}

double day_in_name(const std::string& name) {
  static const std::regex kDate(
      R"((?:^|\D)((?:19|20)\d{2})[-_]?(\d{2})[-_]?(\d{2})(?:[-_T ]+(\d{2})[-_:]?(\d{2}))?)");
  std::smatch parts;
  return std::regex_search(name, parts, kDate) ? day_from(parts) : NAN;
}

}  // namespace kelpie::health
