// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "chart/figure.hpp"
#include "chart/page.hpp"
#include "chart/wording.hpp"
#include "lab/bench_report.hpp"
#include "lab/bench_views.hpp"
#include "study/summary.hpp"

namespace kelpie::lab {
namespace {

constexpr chart::PlotSize kTimesPanel{400, 270};
constexpr std::size_t kMostSteps = 400;

// Whole decades around all values, for a logarithmic axis.
chart::Extent decades(const std::vector<double>& values) {
  const chart::Extent all = chart::range_of(values);
  const double low = std::floor(std::log10(std::max(all.low, 1e-2)));
  const double high = std::ceil(std::log10(std::max(all.high, 1e-1)));
  return {std::pow(10.0, low), std::pow(10.0, std::max(high, low + 1.0))};
}

// The share of updates that took no longer, over time; drawn on the share's distance to 1, so that
// the slowest of thousands are seen.
std::vector<chart::Point> slower_curve(const std::vector<double>& times) {
  std::vector<double> sorted = times;
  std::ranges::sort(sorted);
  std::vector<chart::Point> curve;
  const auto n = static_cast<double>(sorted.size());
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const bool tail = sorted.size() - i <= kMostSteps / 2;
    if (tail || i % (1 + sorted.size() / kMostSteps) == 0) {
      curve.push_back({sorted[i], (n - static_cast<double>(i)) / n});
    }
  }
  return curve;
}

chart::Panel times_panel(const BenchAxis& axis) {
  const std::vector<std::pair<std::string, const std::vector<double>*>> curves = {
      {"path", &axis.whole.update_us},
      {"SMO", &axis.runs[2].update_us},
      {"LIBSVM from scratch", &axis.libsvm_us},
      {"learner, all nodes", &axis.learner_update_us},
      {"learner, prediction", &axis.learner_predict_us}};
  std::vector<double> all;
  double fewest = 1e-1;
  for (const auto& [name, times] : curves) {
    all.insert(all.end(), times->begin(), times->end());
    fewest = std::min(fewest, 1.0 / static_cast<double>(std::max<std::size_t>(1, times->size())));
  }
  chart::Figure figure(
      kTimesPanel, {"time in µs", decades(all), chart::ScaleKind::logarithmic},
      {"share that takes at least so long", {fewest, 1.0}, chart::ScaleKind::logarithmic},
      axis.axis + ": distribution of times per update");
  for (std::size_t i = 0; i < curves.size(); ++i) {
    figure.line(slower_curve(*curves[i].second), i, curves[i].first);
  }
  return {figure.svg(), fmt::format("{}, {}, ε = {} (learner: default settings, no terms).",
                                    stream_text(axis), axis.axis, axis.epsilon)};
}

std::vector<chart::Point> growth_curve(const std::vector<double>& sizes,
                                       const std::vector<double>& times) {
  std::vector<chart::Point> curve;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    curve.push_back({sizes[i], times[i]});
  }
  return curve;
}

chart::Panel growth_panel(const BenchGrowth& growth, const std::string& over) {
  std::vector<double> all = growth.path_us;
  all.insert(all.end(), growth.smo_us.begin(), growth.smo_us.end());
  const chart::Extent sizes = chart::range_of(growth.sizes);
  const chart::Extent wide{0.8 * std::max(sizes.low, 1.0), 1.25 * std::max(sizes.high, 1.0)};
  chart::Figure figure(kTimesPanel, {over, wide, chart::ScaleKind::logarithmic},
                       {"median update in µs", decades(all), chart::ScaleKind::logarithmic},
                       growth.axis + ": median update over the " + over);
  std::size_t style = 0;
  for (const auto& [name, times] :
       {std::pair{"path", &growth.path_us}, std::pair{"SMO", &growth.smo_us}}) {
    const std::vector<chart::Point> curve = growth_curve(growth.sizes, *times);
    figure.line(curve, style, name);
    figure.markers(curve, style++, "");
  }
  return {figure.svg(), growth.axis};
}

template <typename Items, typename Draw>
std::string panels(const std::string& title, const std::string& note, const Items& items,
                   Draw draw) {
  std::string text = "<h2>" + chart::escape_markup(title) + "</h2>\n" +
                     chart::paragraph("note", note) + "<div class=\"grid-panels\">\n";
  for (const auto& item : items) {
    text += chart::figure_of(draw(item));
  }
  return text + "</div>\n";
}

}  // namespace

std::string bench_html(const BenchResult& result) {
  std::string body =
      "<h1>How long kelpie takes</h1>\n" + chart::paragraph("lead", bench_method(result));
  const std::vector<chart::TextTable> tables = bench_tables(result);
  const auto table = [](const chart::TextTable& one) {
    return "<h3>" + chart::escape_markup(one.title) + "</h3>\n" +
           chart::html_table(one.head, one.rows);
  };
  body += table(tables.front());
  body += panels("Distribution of times",
                 "Of all updates, the share that takes at least so long. The path solver over the "
                 "whole stream, SMO and LIBSVM over its first part.",
                 result.axes, times_panel);
  body += panels("Growth with the window", "Both axes logarithmic.", result.over_window,
                 [](const BenchGrowth& growth) { return growth_panel(growth, "window"); });
  body += panels("Growth with the number of inputs",
                 "Synthetic: the stream's first three inputs alone, then several times over, made "
                 "smaller so that all distances stay the same, and with them the problem.",
                 result.over_inputs,
                 [](const BenchGrowth& growth) { return growth_panel(growth, "inputs"); });
  body += "<h2>All figures</h2>\n";
  for (std::size_t i = 1; i < tables.size(); ++i) {
    body += table(tables[i]);
  }
  return chart::html_page("kelpie: bench", body);
}

}  // namespace kelpie::lab
