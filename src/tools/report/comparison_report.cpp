// SPDX-License-Identifier: Apache-2.0
#include "report/comparison_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "chart/page.hpp"
#include "chart/text_table.hpp"
#include "chart/wording.hpp"
#include "core/quantile.hpp"
#include "core/text.hpp"
#include "report/provenance.hpp"
#include "report/recommendation.hpp"
#include "report/stream_figures.hpp"
#include "report/stream_tables.hpp"
#include "report/table.hpp"
#include "report/tuning.hpp"

namespace kelpie::report {
namespace {

using study::ContenderKind;
using study::Contest;

constexpr std::size_t kLongestPlace = 14;  // of a figure that has to fit a phone

bool has_r2(const Contest& contest, const ComparedR2& r2) {
  return std::ranges::any_of(contest.stream.axes, [&](const study::AxisResult& axis) {
    return std::isfinite(axis.*r2.value);
  });
}

// What is not shown breaks the series.
double inside(double r2, chart::Extent range) {
  return r2 < range.low ? std::nan("") : r2;
}

// Where the better half of learners and least squares lies, and some of the range below: what is
// far below would press all others together.
chart::Extent shown_range(const study::Comparison& comparison, const ComparedR2& r2) {
  std::vector<double> values;
  for (const Contest& contest : comparison.contests) {
    const bool is_simple =
        contest.kind == ContenderKind::mean || contest.kind == ContenderKind::last_value;
    for (const study::AxisResult& axis : contest.stream.axes) {
      if (!is_simple && axis.*r2.value >= kTuning.lowest_r2) {
        values.push_back(axis.*r2.value);
      }
    }
  }
  if (values.empty()) {
    return {0.0, 1.0};
  }
  const auto [lowest, high] = chart::range_of(values);
  const double middle = quantile(values, 0.5);
  const double low = std::max(lowest, middle - kTuning.shown_below * (high - middle));
  const double room = 0.1 * std::max(high - low, kTuning.clear_r2);
  return {std::max(low - room, kTuning.lowest_r2), std::min(high + room, 1.0 + room)};
}

// A contender by its mean use over the axes: what is worse than the mean is of no use, however
// much.
struct Ranked {
  const Contest* contest = nullptr;
  double mean = 0.0;
};

// The best first; contenders without R² are left out.
std::vector<Ranked> ranking(const study::Comparison& comparison) {
  std::vector<Ranked> ranked;
  for (const Contest& contest : comparison.contests) {
    double sum = 0.0;
    for (const study::AxisResult& axis : contest.stream.axes) {
      sum += std::isfinite(axis.r2_final) ? std::max(axis.r2_final, 0.0) : 0.0;
    }
    if (has_r2(contest, kHeldOutR2)) {
      ranked.push_back({&contest, sum / static_cast<double>(contest.stream.axes.size())});
    }
  }
  std::ranges::stable_sort(ranked, std::greater<>{}, &Ranked::mean);
  return ranked;
}

// What to use, as a headline of one sentence and what follows.
std::string advice_opening(const study::Comparison& comparison) {
  const std::string settings = settings_advice(comparison);
  const std::string advice = settings.empty() ? recommendation(comparison).front() : settings;
  const std::size_t end = std::min(advice.find(". "), advice.size() - 1) + 1;
  return chart::heading(1, advice.substr(0, end)) +
         (end < advice.size() ? chart::paragraph("lead", advice.substr(end + 1)) : "");
}

}  // namespace

chart::TextTable ranked_view(const study::Comparison& comparison) {
  chart::TextTable table{"Ranked by R² on held-out rows", {"", "mean of the axes"}, {}};
  for (const study::AxisResult& axis : comparison.contests.front().stream.axes) {
    table.head.push_back(chart::shortened(axis.name, chart::kLongestName));
  }
  table.head.emplace_back("behind the best");
  const std::vector<Ranked> ranked = ranking(comparison);
  for (const auto& [contest, mean] : ranked) {
    std::vector<std::string>& row =
        table.rows.emplace_back(std::vector{contest->name, chart::decimal(mean)});
    for (const study::AxisResult& axis : contest->stream.axes) {
      row.push_back(chart::decimal(axis.r2_final));
    }
    row.push_back(contest == ranked.front().contest ? "–"
                                                    : chart::decimal(ranked.front().mean - mean));
  }
  table.notes = {
      "R² on held-out rows, at the end. In the mean, an axis worse than the mean of its rows "
      "counts 0."};
  return table;
}

chart::TextTable comparison_view(const study::Comparison& comparison, const ComparedR2& r2) {
  chart::TextTable table{std::string(r2.title), {"axis"}, {}};
  for (const study::AxisResult& axis : comparison.contests.front().stream.axes) {
    table.rows.push_back({chart::shortened(axis.name, chart::kLongestName)});
  }
  for (const Contest& contest : comparison.contests) {
    if (has_r2(contest, r2)) {
      table.head.push_back(join_text(split_text(contest.name, ' '), "\n"));
      for (std::size_t i = 0; i < table.rows.size(); ++i) {
        table.rows[i].push_back(chart::decimal(contest.stream.axes[i].*r2.value));
      }
    }
  }
  return table;
}

std::string contenders_note(const study::Comparison& comparison) {
  const std::vector<std::string> variants = variants_of(comparison);
  std::string text =
      "All learn the same rows once, in the order of time, and are judged on the "
      "same held-out rows.";
  if (!variants.empty()) {
    text += " " + join_text(variants, ", ") + ": kelpie with one setting more (--set).";
  }
  text += " " + std::string(kBaselineNote) +
          " One step ahead: each sample just before it is learned, those that all have predicted.";
  for (const auto& [name, why] : comparison.left_out) {
    text += " Left out: " + name + " (" + why + ").";
  }
  return text;
}

std::string comparison_figure(const study::Comparison& comparison, const ComparedR2& r2) {
  const std::vector<study::AxisResult>& axes = comparison.contests.front().stream.axes;
  chart::PlotAxis places{"axis", chart::Extent{-0.5, static_cast<double>(axes.size()) - 0.5}};
  for (const study::AxisResult& axis : axes) {
    places.names.push_back(chart::shortened(axis.name, kLongestPlace));
  }
  const chart::Extent range = shown_range(comparison, r2);
  bool clipped = false;
  for (const Contest& contest : comparison.contests) {
    for (const study::AxisResult& axis : contest.stream.axes) {
      clipped = clipped || axis.*r2.value < range.low;
    }
  }
  chart::Figure figure(places, {"R²", range},
                       std::string(r2.title) + ", all contenders, axis by axis");
  const auto contests = static_cast<double>(comparison.contests.size());
  for (std::size_t i = 0; i < comparison.contests.size(); ++i) {
    // One beside the other, so that none hides another.
    const double beside = 0.7 * ((static_cast<double>(i) + 0.5) / contests - 0.5);
    std::vector<chart::Point> points;
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
      points.push_back({static_cast<double>(axis) + beside,
                        inside(comparison.contests[i].stream.axes[axis].*r2.value, range)});
    }
    figure.markers(points, i, comparison.contests[i].name);
  }
  return figure.html(
      std::string("1 is perfect, 0 is no better than always predicting the mean of the rows "
                  "judged.") +
      (clipped ? fmt::format(" What lies below {:.3g} is in the table alone.", range.low) : ""));
}

std::string contenders_figure(const study::Comparison& comparison, std::size_t axis) {
  std::vector<R2Line> lines;
  for (const Contest& contest : comparison.contests) {
    if (contest.kind != ContenderKind::last_value) {
      lines.push_back({contest.name, &contest.stream.axes[axis]});
    }
  }
  return r2_figure(lines, clock_of(comparison.contests.front().stream));
}

std::string comparison_table(const study::Comparison& comparison) {
  std::string text = heading_text(comparison.contests.front().stream);
  for (const ComparedR2& r2 : {kHeldOutR2, kMeanR2, kOneStepR2}) {
    text += chart::table_text(comparison_view(comparison, r2));
  }
  text += chart::wrapped(chart::safe_text(contenders_note(comparison))) + "\n\nRecommendation\n";
  for (const std::string& paragraph : recommendation(comparison)) {
    text += chart::wrapped(chart::safe_text(paragraph)) + "\n";
  }
  return text + "\n";
}

std::string comparison_html(const study::Comparison& comparison) {
  const study::StreamResult& kelpie = comparison.contests.front().stream;
  const std::string log = chart::file_names(kelpie.source);
  const std::string opening = chart::paragraph("over", "kelpie beside simpler models on " + log) +
                              advice_opening(comparison) +
                              chart::html_table(ranked_view(comparison));
  std::string advice;
  for (const std::string& paragraph : recommendation(comparison)) {
    advice += chart::paragraph("", paragraph);
  }
  advice += chart::paragraph("note", contenders_note(comparison));
  const auto figure = [&](const ComparedR2& r2) {
    return chart::heading(3, r2.title) + comparison_figure(comparison, r2);
  };
  const auto table = [&](const ComparedR2& r2) {
    return chart::heading(3, r2.title) + chart::html_table(comparison_view(comparison, r2));
  };
  std::vector<std::string> over_time;
  for (std::size_t axis = 0; axis < kelpie.axes.size(); ++axis) {
    over_time.push_back(chart::heading(3, kelpie.axes[axis].name) +
                        contenders_figure(comparison, axis));
  }
  return chart::html_page(
      "kelpie: compare, " + log, opening,
      {{"Where they differ",
        chart::panels({figure(kHeldOutR2), figure(kMeanR2), figure(kOneStepR2)})},
       {"Axis by axis", advice},
       {"Over the stream", chart::panels(over_time)},
       {"All figures", table(kHeldOutR2) + table(kMeanR2) + table(kOneStepR2), true},
       {"Data", data_section(kelpie), true},
       {"Settings", settings_section(kelpie), true}});
}

}  // namespace kelpie::report
