// SPDX-License-Identifier: Apache-2.0
#include "report/interval_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "chart/wording.hpp"
#include "report/views.hpp"

namespace kelpie::report {
namespace {

constexpr std::size_t kShown = 200;
constexpr double kGapFactor = 1.5;

// Styles as in the figures of the stream.
constexpr std::size_t kTruth = 0;
constexpr std::size_t kPredicted = 1;

// Longer than this between two samples, and they aren't joined: rows between them were held out.
double longest_step(std::span<const double> times) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (const double step = times[i] - times[i - 1]; step > 0.0) {
      least = std::min(least, step);
    }
  }
  return kGapFactor * least;
}

std::vector<chart::Point> curve_of(std::span<const double> times, std::span<const double> values) {
  std::vector<chart::Point> points;
  const double longest = longest_step(times);
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (i > 0 && times[i] - times[i - 1] > longest) {
      points.push_back({times[i], std::numeric_limits<double>::quiet_NaN()});
    }
    points.push_back({times[i], values[i]});
  }
  return points;
}

}  // namespace

chart::Panel interval_panel(const study::AxisResult& axis, chart::PlotSize size) {
  const study::OneStep& steps = axis.one_step;
  const std::size_t rows = std::min(kShown, steps.truth.size());
  std::vector<double> all;
  const auto last = [&](const std::vector<double>& values) {
    const std::span<const double> tail = std::span(values).last(rows);
    all.insert(all.end(), tail.begin(), tail.end());
    return tail;
  };
  const std::span<const double> times = std::span(steps.time_s).last(rows);
  const std::vector<chart::Point> low = curve_of(times, last(steps.lower));
  const std::vector<chart::Point> high = curve_of(times, last(steps.upper));
  const std::vector<chart::Point> truth = curve_of(times, last(steps.truth));
  const std::vector<chart::Point> predicted = curve_of(times, last(steps.predicted));
  const std::string name = chart::shortened(axis.name, chart::kLongestName);
  chart::Figure figure(
      size, {"time in s", chart::range_of(times)},
      {name + " in " + (axis.unit.empty() ? "the log's own unit" : axis.unit),
       chart::widened(chart::range_of(all), 0.04)},
      axis.name + ": the last samples, true and predicted one step ahead, with interval");
  figure.band(low, high, kPredicted, "interval");
  figure.line(truth, kTruth, "true");
  figure.line(predicted, kPredicted, "predicted");
  return {figure.svg(),
          fmt::format("The last {} training samples, each predicted just before it was learned; "
                      "gaps in time are not joined.",
                      chart::grouped(static_cast<std::int64_t>(rows)))};
}

chart::Panel coverage_panel(const study::StreamResult& result, chart::PlotSize size) {
  std::vector<std::vector<chart::Point>> curves;
  double low = 1.0;
  double last = 1.0;
  for (const study::AxisResult& axis : result.axes) {
    const std::vector<double> shares = study::running_coverage(axis.one_step);
    std::vector<chart::Point>& curve = curves.emplace_back();
    for (std::size_t i = 0; i < shares.size(); ++i) {
      curve.push_back({static_cast<double>(axis.one_step.samples[i]), 100.0 * shares[i]});
      low = std::fmin(low, shares[i]);
      last = std::max(last, curve.back().x);
    }
  }
  chart::Figure figure(size, {"training samples shown", {0.0, last}},
                       {"held, % of 500 samples", {std::floor(20.0 * low - 0.2) * 5.0, 100.0}},
                       "Share of samples inside their interval over the stream");
  for (std::size_t i = 0; i < curves.size(); ++i) {
    figure.line(curves[i], i, chart::shortened(result.axes[i].name, chart::kLongestName));
  }
  if (!result.axes.empty()) {
    for (const Switch& change : switches(result.axes.front())) {
      figure.mark(change.samples, fmt::format("configuration {}", change.configuration));
    }
  }
  return {figure.svg(),
          "Share of the last 500 samples of the same configuration that were inside "
          "the interval in force before they were learned."};
}

chart::Panel novelty_panel(const study::AxisResult& axis, chart::PlotSize size) {
  std::vector<chart::Box> boxes;
  double most = 0.0;
  std::size_t rows = 0;
  for (const study::NoveltyBin& bin : axis.novelty) {
    if (bin.rows > 0) {
      boxes.push_back({bin.from, bin.to, 0.0, bin.rms_error});
      most = std::max(most, bin.rms_error);
      rows += bin.rows;
    }
  }
  const std::string unit = axis.unit.empty() ? "log's own unit" : axis.unit;
  chart::Figure figure(size, {"novelty", {0.0, 1.0}}, {"error, RMS, " + unit, {0.0, 1.05 * most}},
                       axis.name + ": error on held-out rows by novelty");
  figure.boxes(boxes, kTruth, "");
  return {figure.svg(), fmt::format("{} held-out rows by the model at the end of the stream.",
                                    chart::grouped(static_cast<std::int64_t>(rows)))};
}

}  // namespace kelpie::report
