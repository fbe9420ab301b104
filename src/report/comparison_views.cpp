// SPDX-License-Identifier: Apache-2.0
#include "report/comparison_views.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "chart/wording.hpp"
#include "kelpie/core/text.hpp"
#include "report/stream_figures.hpp"
#include "report/yardstick_table.hpp"

namespace kelpie::report {
namespace {

using study::ContenderKind;
using study::Contest;

constexpr double kLowestShown = -0.2;
constexpr double kHighestLow = 0.9;
constexpr std::size_t kLongestRow = 14;  // of a figure that has_r2 to fit a phone

bool has_r2(const Contest& contest, const ComparedR2& r2) {
  return std::ranges::any_of(contest.stream.axes, [&](const study::AxisResult& axis) {
    return std::isfinite(axis.*r2.value);
  });
}

// Lower end of the R² axis: a round number below everything, but never below kLowestShown.
double lowest_compared(const study::Comparison& comparison, const ComparedR2& r2) {
  std::vector<double> values;
  for (const Contest& contest : comparison.contests) {
    for (const study::AxisResult& axis : contest.stream.axes) {
      values.push_back(axis.*r2.value);
    }
  }
  return std::clamp(std::floor(20.0 * chart::range_of(values).low) / 20.0, kLowestShown,
                    kHighestLow);
}

chart::PlotAxis rows_axis(const std::vector<study::AxisResult>& axes) {
  const auto count = static_cast<double>(axes.size());
  chart::PlotAxis rows{"axis", {-0.5, count - 0.5}};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    rows.names.push_back(
        {count - 1.0 - static_cast<double>(i), chart::shortened(axes[i].name, kLongestRow)});
  }
  return rows;
}

}  // namespace

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
  std::vector<std::string> variants;
  for (const Contest& contest : comparison.contests) {
    if (contest.kind == ContenderKind::variant) {
      variants.push_back(contest.name);
    }
  }
  std::string text =
      "All learn the same rows once, in the order of time, and are judged on the "
      "same held-out rows.";
  if (!variants.empty()) {
    text += " " + join_text(variants, ", ") + ": kelpie with one setting more (--set).";
  }
  text += " " + std::string(kYardstickNote) +
          " One step ahead: each sample just before it is learned, those that all have predicted.";
  for (const auto& [name, why] : comparison.left_out) {
    text += " Left out: " + name + " (" + why + ").";
  }
  return text;
}

chart::Panel comparison_panel(const study::Comparison& comparison, const ComparedR2& r2,
                              int width) {
  const std::vector<study::AxisResult>& axes = comparison.contests.front().stream.axes;
  const double low = lowest_compared(comparison, r2);
  const auto contests = static_cast<double>(comparison.contests.size());
  const int height = 54 + static_cast<int>(axes.size() * (9 * comparison.contests.size() + 8));
  chart::Figure figure({width, height}, {std::string(r2.title), {low, 1.0}}, rows_axis(axes),
                       std::string(r2.title) + ", all contenders, axis by axis");
  figure.reference({0.0, -0.5}, {0.0, static_cast<double>(axes.size()) - 0.5});
  bool clipped = false;
  for (std::size_t i = 0; i < comparison.contests.size(); ++i) {
    const Contest& contest = comparison.contests[i];
    // One below the other, so that none hides another.
    const double below = 0.8 * ((static_cast<double>(i) + 0.5) / contests - 0.5);
    std::vector<chart::Point> points;
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
      const double value = contest.stream.axes[axis].*r2.value;
      points.push_back({value, static_cast<double>(axes.size() - 1 - axis) - below});
      clipped = clipped || value < low;
    }
    figure.markers(points, i, has_r2(contest, r2) ? contest.name : "");
  }
  return {figure.svg(),
          std::string("1 is perfect, 0 is no better than always predicting the mean of the rows "
                      "judged.") +
              (clipped ? " What lies below −0.2 is drawn on the edge." : "")};
}

chart::Panel contenders_panel(const study::Comparison& comparison, std::size_t axis,
                              chart::PlotSize size) {
  std::vector<R2Line> lines;
  for (const Contest& contest : comparison.contests) {
    if (contest.kind != ContenderKind::last_value) {
      lines.push_back({contest.name, &contest.stream.axes[axis]});
    }
  }
  return r2_panel(lines, size);
}

}  // namespace kelpie::report
