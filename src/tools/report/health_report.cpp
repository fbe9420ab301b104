// SPDX-License-Identifier: Apache-2.0
#include "report/health_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "chart/figure.hpp"
#include "chart/page.hpp"
#include "chart/text_table.hpp"
#include "chart/wording.hpp"
#include "core/quantile.hpp"
#include "health/tuning.hpp"

namespace kelpie::report {
namespace {

using health::Change;
using health::CourseKind;
using health::Estimate;
using health::HealthCard;

constexpr std::size_t kMostEpisodes = 60;  // of a table

std::string baseline_words(const HealthCard& card, const Change& change) {
  return change.baseline == 0
             ? ""
             : fmt::format(" (counted since {})", card.baselines[change.baseline].name);
}

// The changes that were found, the most certain first.
std::vector<const Change*> found_changes(const HealthCard& card) {
  std::vector<const Change*> found;
  for (const Change& change : card.changes) {
    if (health::is_found(change.course)) {
      found.push_back(&change);
    }
  }
  std::ranges::stable_sort(found, [](const Change* a, const Change* b) {
    return a->baseline != b->baseline ? a->baseline < b->baseline : a->course.nats > b->course.nats;
  });
  return found;
}

std::string span_text(const HealthCard& card) {
  const health::HealthTable& table = card.table;
  double hours = 0.0;
  for (const health::Episode& episode : table.episodes) {
    hours += episode.hours;
  }
  return fmt::format("{}: {} episode{}, {:.3g} h of logs, {} to {}", card.vehicle,
                     table.episodes.size(), table.episodes.size() == 1 ? "" : "s", hours,
                     health::day_text(card, table.episodes.front().day),
                     health::day_text(card, table.episodes.back().day));
}

bool has_too_few_episodes(const HealthCard& card) {
  return std::ranges::all_of(
      card.changes, [](const Change& change) { return change.course.kind == CourseKind::unknown; });
}

// The given days since which no quantity has enough episodes for a change.
std::vector<std::string> untold_baselines(const HealthCard& card) {
  std::vector<std::string> names;
  for (std::size_t i = 1; i < card.baselines.size(); ++i) {
    const bool is_told = std::ranges::any_of(card.changes, [&](const Change& change) {
      return change.baseline == i && change.course.kind != CourseKind::unknown;
    });
    if (!is_told) {
      names.push_back(card.baselines[i].name);
    }
  }
  return names;
}

// What no significant change bounds: the widest of the intervals since deployment.
std::string quiet_text(const HealthCard& card) {
  std::vector<std::string> quiet;
  for (const Change& change : card.changes) {
    if (change.baseline == 0 && change.course.kind == CourseKind::constant) {
      quiet.push_back(fmt::format("{} ({})", card.table.quantities[change.quantity].name,
                                  health::change_size(card, change)));
    }
  }
  return quiet.empty() ? "" : "No change: " + chart::list_text(quiet) + ".";
}

std::string value_text(const health::Quantity& quantity, const Estimate& estimate) {
  if (!(estimate.error > 0.0)) {
    return "–";
  }
  const double scale = quantity.unit.empty() ? 100.0 : 1.0;
  const double half = scale * kNormal90 * estimate.error;
  return health::rounded(scale * estimate.value, half) + " ± " + health::rounded(half, half);
}

chart::TextTable episodes_view(const HealthCard& card) {
  const health::HealthTable& table = card.table;
  chart::TextTable view{"By episode", {"episode", "day"}, {}};
  view.left = {0, 1};
  for (const health::Quantity& quantity : table.quantities) {
    view.head.push_back(quantity.name + "\n[" + (quantity.unit.empty() ? "%" : quantity.unit) +
                        "]");
  }
  const std::size_t first =
      table.episodes.size() > kMostEpisodes ? table.episodes.size() - kMostEpisodes : 0;
  for (std::size_t i = first; i < table.episodes.size(); ++i) {
    view.rows.push_back({chart::shortened(table.episodes[i].name, chart::kLongestName),
                         card.is_dated ? health::day_text(card, table.episodes[i].day)
                                       : fmt::format("{:.2f}", table.episodes[i].day)});
    for (std::size_t k = 0; k < table.quantities.size(); ++k) {
      view.rows.back().push_back(value_text(table.quantities[k], table.estimates[i][k]));
    }
  }
  view.notes.emplace_back(
      "Values with half of their 90 % intervals. Per cent: of the mean over all episodes.");
  if (first > 0) {
    view.notes.push_back(fmt::format("The last {} of {}; health.json has all.", kMostEpisodes,
                                     table.episodes.size()));
  }
  return view;
}

chart::TextTable changes_view(const HealthCard& card) {
  chart::TextTable view{"Changes", {"quantity", "since", "found", "evidence\n[nats]"}, {}};
  view.left = {0, 1, 2};
  for (const Change& change : card.changes) {
    view.rows.push_back({card.table.quantities[change.quantity].name,
                         card.baselines[change.baseline].name, health::change_text(card, change),
                         fmt::format("{:.1f}", change.course.nats)});
  }
  view.notes.push_back(fmt::format(
      "± is half of a 90 % interval. Found: evidence above {:g} nats, beyond what the search over "
      "all dates finds by chance.",
      health::kTuning.least_nats));
  view.whole = true;
  return view;
}

// Points of the fitted course at an episode's day.
double course_at(const health::Course& course, double day) {
  if (!health::is_found(course)) {
    return course.before.value;
  }
  if (course.kind == CourseKind::drift) {
    return course.before.value + course.rate.value * std::max(0.0, day - course.since_day);
  }
  return course.before.value + (day >= course.since_day ? course.change.value : 0.0);
}

std::string quantity_figure(const HealthCard& card, const Change& change) {
  const health::Quantity& quantity = card.table.quantities[change.quantity];
  const health::Series series = health::series_of(card.table, change.quantity);
  const double scale = quantity.unit.empty() ? 100.0 : 1.0;
  const double first = card.is_dated ? card.table.episodes.front().day : 0.0;
  std::vector<chart::Point> points;
  std::vector<chart::Point> course;
  std::vector<double> halves;
  for (std::size_t i = 0; i < series.days.size(); ++i) {
    const double x = series.days[i] - first;
    points.push_back({x, scale * series.estimates[i].value});
    halves.push_back(scale * kNormal90 * series.estimates[i].error);
    course.push_back({x, scale * course_at(change.course, series.days[i])});
  }
  chart::Figure figure(
      {card.is_dated ? "days since " + health::day_text(card, first) : "day", {}},
      {fmt::format("{} [{}]", quantity.name, quantity.unit.empty() ? "%" : quantity.unit), {}},
      quantity.name + " from episode to episode");
  figure.band(points, halves, 0, "90 % interval");
  figure.markers(points, 0, "estimate");
  if (change.course.kind != CourseKind::unknown && change.course.kind != CourseKind::undecided) {
    figure.line(course, 1, "course");
  }
  for (std::size_t i = 1; i < card.baselines.size(); ++i) {
    figure.mark(card.baselines[i].day - first, card.baselines[i].name);
  }
  if (health::is_found(change.course)) {
    figure.mark(change.course.since_day - first, "change");
  }
  return figure.html(health::change_text(card, change) + ".");
}

std::string health_figures(const HealthCard& card) {
  std::vector<std::string> all;
  for (const Change& change : card.changes) {
    if (change.baseline == 0 && health::series_of(card.table, change.quantity).days.size() > 1) {
      all.push_back(quantity_figure(card, change));
    }
  }
  return chart::panels(all);
}

std::size_t changed_vehicles(const std::vector<HealthCard>& cards) {
  return static_cast<std::size_t>(std::ranges::count_if(
      cards, [](const HealthCard& card) { return !found_changes(card).empty(); }));
}

std::string health_headline(const std::vector<HealthCard>& cards) {
  if (cards.size() > 1) {
    return fmt::format("{} of {} vehicles changed.", changed_vehicles(cards), cards.size());
  }
  const std::vector<const Change*> found = found_changes(cards.front());
  if (found.empty()) {
    return has_too_few_episodes(cards.front()) ? "Too few episodes to tell a change."
                                               : "No significant change was found.";
  }
  return health::change_text(cards.front(), *found.front()) + ".";
}

}  // namespace

std::string health_verdict(const std::vector<HealthCard>& cards) {
  std::string text;
  for (const HealthCard& card : cards) {
    text += chart::wrapped(chart::safe_text(span_text(card))) + "\n";
    const std::vector<const Change*> found = found_changes(card);
    for (const Change* change : found) {
      text += chart::wrapped("  " + chart::safe_text(health::change_text(card, *change) +
                                                     baseline_words(card, *change))) +
              "\n";
    }
    if (found.empty()) {
      text += has_too_few_episodes(card) ? "  too few episodes to tell a change\n"
                                         : "  no significant change\n";
    }
    if (const std::vector<std::string> untold = untold_baselines(card);
        !untold.empty() && !has_too_few_episodes(card)) {
      text += chart::wrapped("  " + chart::safe_text("since " + chart::list_text(untold) +
                                                     ": too few episodes to tell a change")) +
              "\n";
    }
    if (const std::string quiet = quiet_text(card); !quiet.empty() && cards.size() == 1) {
      text += chart::wrapped(chart::safe_text(quiet)) + "\n";
    }
    for (const std::string& remark : card.table.remarks) {
      text += chart::wrapped(chart::safe_text(remark)) + "\n";
    }
  }
  return text;
}

std::string health_tables(const std::vector<HealthCard>& cards) {
  std::string text;
  for (const HealthCard& card : cards) {
    text += chart::safe_text(span_text(card)) + "\n\n" +
            chart::tables_text({changes_view(card), episodes_view(card)});
  }
  return text;
}

std::string health_html(const std::vector<HealthCard>& cards) {
  const std::string headline = health_headline(cards);
  std::string opening =
      chart::paragraph(
          "over", "Health of " + (cards.size() == 1 ? cards.front().vehicle
                                                    : fmt::format("{} vehicles", cards.size()))) +
      chart::heading(1, headline);
  std::vector<chart::Section> sections;
  std::vector<chart::Section> values;
  for (const HealthCard& card : cards) {
    opening += chart::paragraph("", span_text(card) + ".");
    for (const Change* change : found_changes(card)) {
      const std::string news = health::change_text(card, *change) + baseline_words(card, *change);
      opening += news + "." == headline ? "" : chart::paragraph("", news + ".");
    }
    for (const std::string& remark : card.table.remarks) {
      opening += chart::paragraph("note", remark + ".");
    }
    sections.push_back(
        {card.vehicle, health_figures(card) + chart::html_table(changes_view(card))});
    values.push_back({card.vehicle + " by episode", chart::html_table(episodes_view(card)), true});
  }
  std::ranges::move(values, std::back_inserter(sections));
  return chart::html_page("kelpie: health", opening, sections);
}

}  // namespace kelpie::report
