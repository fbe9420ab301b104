// SPDX-License-Identifier: Apache-2.0
#include "report/comparison_views.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "chart/wording.hpp"
#include "kelpie/core/text.hpp"
#include "report/stream_figures.hpp"
#include "report/stream_tables.hpp"

namespace kelpie::report {
namespace {

using study::ContenderKind;
using study::Contest;

constexpr double kLowestShown = -0.2;
constexpr std::size_t kLongestPlace = 14;  // of a figure that has to fit a phone

bool has_r2(const Contest& contest, const ComparedR2& r2) {
  return std::ranges::any_of(contest.stream.axes, [&](const study::AxisResult& axis) {
    return std::isfinite(axis.*r2.value);
  });
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
  double low = 0.9;
  bool clipped = false;
  for (const Contest& contest : comparison.contests) {
    for (const study::AxisResult& axis : contest.stream.axes) {
      low = std::fmin(low, std::floor(20.0 * (axis.*r2.value)) / 20.0);
      clipped = clipped || axis.*r2.value < kLowestShown;
    }
  }
  chart::Figure figure(places, {"R²", chart::Extent{std::max(low, kLowestShown), 1.02}},
                       std::string(r2.title) + ", all contenders, axis by axis");
  const auto contests = static_cast<double>(comparison.contests.size());
  for (std::size_t i = 0; i < comparison.contests.size(); ++i) {
    // One beside the other, so that none hides another.
    const double beside = 0.7 * ((static_cast<double>(i) + 0.5) / contests - 0.5);
    std::vector<chart::Point> points;
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
      points.push_back(
          {static_cast<double>(axis) + beside, comparison.contests[i].stream.axes[axis].*r2.value});
    }
    figure.markers(points, i, comparison.contests[i].name);
  }
  return figure.html(
      std::string("1 is perfect, 0 is no better than always predicting the mean of the rows "
                  "judged.") +
      (clipped ? " What lies below −0.2 is in the table alone." : ""));
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

}  // namespace kelpie::report
