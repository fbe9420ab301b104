// SPDX-License-Identifier: Apache-2.0
#include "report/comparison_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include "chart/page.hpp"
#include "chart/text_table.hpp"
#include "chart/wording.hpp"
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
      clipped = clipped || axis.*r2.value < kTuning.lowest_r2;
    }
  }
  chart::Figure figure(places, {"R²", chart::Extent{std::max(low, kTuning.lowest_r2), 1.02}},
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

std::string comparison_table(const study::Comparison& comparison) {
  std::string text = heading_text(comparison.contests.front().stream);
  for (const ComparedR2& r2 : {kHeldOutR2, kMeanR2, kOneStepR2}) {
    text += chart::table_text(comparison_view(comparison, r2));
  }
  text += chart::wrapped(chart::printable(contenders_note(comparison))) + "\n\nRecommendation\n";
  for (const std::string& paragraph : recommendation(comparison)) {
    text += chart::wrapped(chart::printable(paragraph)) + "\n";
  }
  return text + "\n";
}

std::string comparison_html(const study::Comparison& comparison) {
  const study::StreamResult& kelpie = comparison.contests.front().stream;
  const std::string log = std::filesystem::path(kelpie.source).filename().string();
  const std::string title = "kelpie beside simpler models on " + log;
  std::string opening = chart::heading(1, title);
  for (const std::string& paragraph : recommendation(comparison)) {
    opening += chart::paragraph("lead", paragraph);
  }
  opening += chart::paragraph("note", contenders_note(comparison));
  const auto section = [&](const ComparedR2& r2) {
    return comparison_figure(comparison, r2) + chart::html_table(comparison_view(comparison, r2));
  };
  std::string over_time;
  for (std::size_t axis = 0; axis < kelpie.axes.size(); ++axis) {
    over_time += chart::heading(3, kelpie.axes[axis].name) + contenders_figure(comparison, axis);
  }
  return chart::html_page(title, opening,
                          {{"At the end of the stream", section(kHeldOutR2)},
                           {"Mean over the stream", section(kMeanR2)},
                           {"One step ahead", section(kOneStepR2)},
                           {"Over the stream", over_time},
                           {"Data", data_section(kelpie)},
                           {"Settings", settings_section(kelpie)}});
}

}  // namespace kelpie::report
