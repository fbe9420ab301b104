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

constexpr std::size_t kMostSteps = 400;

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
      curve.push_back({std::max(sorted[i], 1e-2), (n - static_cast<double>(i)) / n});
    }
  }
  return curve;
}

std::string times_figure(const BenchAxis& axis) {
  chart::Figure figure({"time in µs", {}, chart::ScaleKind::logarithmic},
                       {"share that takes at least so long", {}, chart::ScaleKind::logarithmic},
                       axis.axis + ": distribution of times per update");
  figure.line(slower_curve(axis.whole.update_us), 0, "path");
  figure.line(slower_curve(axis.runs[2].update_us), 1, "SMO");
  figure.line(slower_curve(axis.libsvm_us), 2, "LIBSVM from scratch");
  figure.line(slower_curve(axis.learner_update_us), 3, "learner, all nodes");
  figure.line(slower_curve(axis.learner_predict_us), 4, "learner, prediction");
  return figure.html(fmt::format("{}, {}, ε = {} (learner: default settings, no terms).",
                                 stream_text(axis), axis.axis, axis.epsilon));
}

std::string model_figure(const UpdateTimes& times) {
  chart::Figure figure({"time in µs", {}, chart::ScaleKind::logarithmic},
                       {"share that takes at least so long", {}, chart::ScaleKind::logarithmic},
                       "model of three axes: distribution of times per update");
  figure.line(slower_curve(times.thread_us), 0, "the thread's own time");
  figure.line(slower_curve(times.wall_us), 1, "on the wall");
  return figure.html(times_method(times));
}

std::vector<chart::Point> growth_curve(const std::vector<double>& sizes,
                                       const std::vector<double>& times) {
  std::vector<chart::Point> curve;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    curve.push_back({sizes[i], times[i]});
  }
  return curve;
}

std::string growth_figure(const BenchGrowth& growth, const std::string& over) {
  chart::Figure figure({over, {}, chart::ScaleKind::logarithmic},
                       {"median update in µs", {}, chart::ScaleKind::logarithmic},
                       growth.axis + ": median update over the " + over);
  figure.line(growth_curve(growth.sizes, growth.path_us), 0, "path");
  figure.line(growth_curve(growth.sizes, growth.smo_us), 1, "SMO");
  return figure.html(growth.axis);
}

template <typename Items, typename Draw>
std::string panels(const std::string& note, const Items& items, Draw draw) {
  std::vector<std::string> figures;
  for (const auto& item : items) {
    figures.push_back(draw(item));
  }
  return chart::paragraph("note", note) + chart::panels(figures);
}

}  // namespace

std::string bench_html(const BenchResult& result) {
  const std::vector<chart::TextTable> tables = bench_tables(result);
  const auto table = [](const chart::TextTable& one) {
    return chart::heading(3, one.title) + chart::html_table(one.head, one.rows);
  };
  std::string others;
  for (std::size_t i = 1; i < tables.size(); ++i) {
    others += table(tables[i]);
  }
  return chart::html_page(
      "kelpie: bench",
      chart::heading(1, "How long kelpie takes") + chart::paragraph("lead", bench_method(result)) +
          table(tables.front()),
      {{"Distribution of times",
        panels("Of all updates, the share that takes at least so long. The path solver over the "
               "whole stream, SMO and LIBSVM over its first part.",
               result.axes, times_figure)},
       {"Single updates of a model", chart::panels({model_figure(result.model)})},
       {"Growth with the window",
        panels("Both axes logarithmic.", result.over_window,
               [](const BenchGrowth& growth) { return growth_figure(growth, "window"); })},
       {"Growth with the number of inputs",
        panels("Synthetic: the stream's first three inputs alone, then several times over, made "
               "smaller so that all distances stay the same, and with them the problem.",
               result.over_inputs,
               [](const BenchGrowth& growth) { return growth_figure(growth, "inputs"); })},
       {"All figures", others}});
}

}  // namespace kelpie::lab
