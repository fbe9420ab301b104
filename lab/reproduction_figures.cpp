// SPDX-License-Identifier: Apache-2.0
#include "lab/reproduction_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "chart/wording.hpp"
#include "lab/reproduction_views.hpp"
#include "report/stream_figures.hpp"

namespace kelpie::lab {
namespace {

constexpr double kLowestR2 = -0.2;
constexpr std::size_t kBaselineStyle = 6;

// Beyond which a figure would show nothing but a learner's first steps.
double lowest_of(const std::vector<MeanCurve>& curves, bool& clipped) {
  double low = 0.8;
  for (const MeanCurve& curve : curves) {
    for (const chart::Point& point : curve.low) {
      low = std::fmin(low, point.y);
    }
  }
  clipped = low < kLowestR2;
  return std::clamp(std::floor(5.0 * low) / 5.0, kLowestR2, 0.8);
}

// The contender's look is the same in every figure: by its place in the study, pairs alike.
std::size_t style_of(const StreamStudy& study, const std::string& key) {
  const auto found = std::ranges::find(study.contenders, key, &ContenderRuns::key);
  const auto place = static_cast<std::size_t>(found - study.contenders.begin());
  return key == "proposed_small" ? 0 : key == "fifo_small" ? 1 : place;
}

std::vector<chart::Point> baseline_steps(const StreamStudy& study, std::size_t axis) {
  std::vector<chart::Point> steps;
  double from = 0.0;
  for (std::size_t stage = 0; stage < stages_of(study); ++stage) {
    const auto to =
        static_cast<double>(study.contenders.front().seeds.front().front().stages[stage].samples);
    const double r2 = baseline_r2(study, axis, stage);
    steps.push_back({from, r2});
    steps.push_back({to - 0.5, r2});
    from = to;
  }
  return steps;
}

void add_band(chart::Figure& figure, const MeanCurve& curve, std::size_t style) {
  std::vector<chart::Point> middle;
  std::vector<double> half;
  for (std::size_t i = 0; i < curve.low.size(); ++i) {
    middle.push_back({curve.low[i].x, 0.5 * (curve.low[i].y + curve.high[i].y)});
    half.push_back(0.5 * (curve.high[i].y - curve.low[i].y));
  }
  figure.band(middle, half, style);
}

}  // namespace

std::string comparison_figure(const StreamStudy& study, const std::vector<std::string>& keys,
                              std::size_t axis) {
  std::vector<MeanCurve> curves;
  curves.reserve(keys.size());
  for (const std::string& key : keys) {
    curves.push_back(mean_curve(*find_contender(study, key), axis));
  }
  bool clipped = false;
  const double low = lowest_of(curves, clipped);
  chart::Figure figure({"training samples shown"}, {"R² on held-out rows", chart::Extent{low, 1.0}},
                       study.axes[axis] + ": validation R² over the stream, " + study.split);
  figure.link(study.key + study.split_kind);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (find_contender(study, keys[i])->seeds.size() > 1) {
      add_band(figure, curves[i], style_of(study, keys[i]));
    }
  }
  if (!study.offline.empty()) {
    figure.line(baseline_steps(study, axis), kBaselineStyle, "off-line baseline");
  }
  for (std::size_t i = 0; i < keys.size(); ++i) {
    figure.line(curves[i].mean, style_of(study, keys[i]), find_contender(study, keys[i])->name);
  }
  const std::vector<study::StageEnd>& stages = study.contenders.front().seeds.front()[axis].stages;
  for (std::size_t stage = 1; stage < stages.size(); ++stage) {
    figure.mark(static_cast<double>(stages[stage - 1].samples),
                fmt::format("configuration {}", stages[stage].configuration + 1));
  }
  return figure.html(clipped ? "What lies below −0.2 is outside the figure." : "");
}

std::string prediction_figure(const StreamStudy& study, std::string_view key, std::size_t axis,
                              std::size_t stage) {
  const study::AxisResult& run = find_contender(study, key)->seeds.front()[axis];
  const study::StageEnd& end = run.stages[stage];
  const chart::Extent span = chart::range_of(end.time_s);
  const report::Clock clock{span.low, {0.0, span.high - span.low}};
  chart::Figure figure(clock.axis(), {run.name},
                       run.name + ": held-out rows, true and predicted, over time");
  figure.link(fmt::format("{} stage {}", study.key, stage));
  figure.line(report::over_time(clock, end.time_s, end.truth), 0, "true");
  figure.line(report::over_time(clock, end.time_s, end.predicted), 1, "predicted");
  return figure.html(fmt::format("R² {} on all {} held-out rows of configuration {}.",
                                 chart::decimal(end.r2), chart::grouped(end.truth.size()),
                                 end.configuration + 1));
}

std::string published_figure(const std::vector<PublishedRun>& runs) {
  chart::Figure figure({"steps after the first 100 samples"},
                       {"R² on the test rows, mean of three axes", chart::Extent{kLowestR2, 1.0}},
                       "R² over the steps of the published protocol");
  std::vector<std::vector<chart::Point>> lines;
  double last = 1.0;
  for (const PublishedRun& run : runs) {
    std::vector<chart::Point>& line = lines.emplace_back();
    for (std::size_t i = 0; i < run.steps.size(); ++i) {
      line.push_back({static_cast<double>(run.steps[i]), run.r2[i]});
      last = std::max(last, line.back().x);
    }
  }
  const auto level = [&](double r2, std::size_t style, const std::string& name) {
    figure.line(std::vector<chart::Point>{{0.0, r2}, {last, r2}}, style, name);
  };
  level(kPublished[3].mean, 3, "published, greedy: mean of the run");
  level(kPublished[0].mean, 4, "published, FIFO: mean of the run");
  for (std::size_t i = 0; i < runs.size(); ++i) {
    figure.line(lines[i], i, runs[i].name);
  }
  return figure.html("What lies below −0.2 is outside the figure.");
}

}  // namespace kelpie::lab
