// SPDX-License-Identifier: Apache-2.0
#include "report/stream_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <vector>

#include "chart/wording.hpp"
#include "report/views.hpp"
#include "study/summary.hpp"
#include "study/terms.hpp"

namespace kelpie::report {
namespace {

constexpr double kLowestR2 = -0.2;
constexpr double kLeastCount = 4.0;  // top of an axis that counts: whole numbers as ticks
constexpr std::size_t kStretchRows = 300;
constexpr std::size_t kMostDots = 1500;
constexpr std::size_t kMostIntervals = 60;
constexpr std::size_t kMostTermLines = 7;  // as many as there are colours
constexpr const char* kStreamLabel = "training samples shown";

// Styles that mean the same in every figure.
constexpr std::size_t kTruth = 0;
constexpr std::size_t kPredicted = 1;

std::string short_name(const study::AxisResult& axis) {
  return chart::shortened(axis.name, chart::kLongestName);
}

// An interrupted stream may have gone on after its last validation point.
chart::Extent stream_range(const study::AxisResult& axis) {
  const std::size_t last = axis.validation.empty() ? 0 : axis.validation.back().samples;
  return {0.0, static_cast<double>(std::max({last, axis.update_us.size(), std::size_t{1}}))};
}

void mark_switches(chart::Figure& figure, const study::AxisResult& axis) {
  for (const Switch& change : switches(axis)) {
    figure.mark(change.samples, fmt::format("configuration {}", change.configuration));
  }
}

std::vector<double> parts(std::span<const chart::Point> points, double chart::Point::*part) {
  std::vector<double> values(points.size());
  std::transform(points.begin(), points.end(), values.begin(), std::mem_fn(part));
  return values;
}

// Both together, so that truth and prediction share their axis.
chart::Extent common_range(std::vector<double> a, const std::vector<double>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return chart::widened(chart::range_of(a), 0.04);
}

// One-pass summary of what the R² figure can't show.
struct Clipped {
  std::size_t count = 0;
  double lowest = 0.0;
  std::string line;
};

Clipped clipped_by(const std::vector<R2Line>& lines, double low) {
  Clipped clipped;
  for (const R2Line& line : lines) {
    for (const chart::Point& point : r2_curve(*line.axis)) {
      if (std::isfinite(point.y) && point.y < low) {
        ++clipped.count;
        if (point.y < clipped.lowest) {
          clipped.lowest = point.y;
          clipped.line = line.name;
        }
      }
    }
  }
  return clipped;
}

// Lower end of the R² axis: a round number below everything, but never below kLowestR2; 0 without
// any R².
double lowest_shown(const std::vector<R2Line>& lines) {
  std::vector<double> values;
  for (const R2Line& line : lines) {
    const std::vector<double> more = parts(r2_curve(*line.axis), &chart::Point::y);
    values.insert(values.end(), more.begin(), more.end());
  }
  return std::clamp(std::floor(5.0 * chart::range_of(values).low) / 5.0, kLowestR2, 0.8);
}

double largest(std::initializer_list<double> values, double floor) {
  return std::max(floor, std::max(values));
}

}  // namespace

chart::Panel r2_panel(const std::vector<R2Line>& lines, chart::PlotSize size) {
  const double low = lowest_shown(lines);
  chart::Extent range{0.0, 1.0};
  for (const R2Line& line : lines) {
    range.high = std::max(range.high, stream_range(*line.axis).high);
  }
  chart::Figure figure(size, {kStreamLabel, range}, {"R² on held-out rows", {low, 1.0}},
                       "Validation R² over the stream");
  for (std::size_t i = 0; i < lines.size(); ++i) {
    figure.line(r2_curve(*lines[i].axis), i, lines[i].name);
  }
  if (!lines.empty()) {
    mark_switches(figure, *lines.front().axis);
  }
  for (const R2Line& line : lines) {
    for (const study::ChangeFound& change : line.axis->changes) {
      figure.mark(static_cast<double>(change.samples),
                  line.name + (change.recalled > 0 ? ": known again" : ": change found"));
    }
  }
  std::string caption =
      "R² on the held-out rows of the configuration then running; 1 is perfect, 0 is no better "
      "than always predicting their mean.";
  if (const Clipped clipped = clipped_by(lines, low); clipped.count > 0) {
    caption += fmt::format(
        " Clipped: points below −0.2 are drawn on the lower edge ({} of them, the lowest {} for "
        "{}).",
        clipped.count, chart::decimal(clipped.lowest), clipped.line);
  }
  return {figure.svg(), caption};
}

chart::Panel r2_panel(const study::StreamResult& result, chart::PlotSize size) {
  std::vector<R2Line> lines;
  lines.reserve(result.axes.size());
  for (const study::AxisResult& axis : result.axes) {
    lines.push_back({short_name(axis), &axis});
  }
  return r2_panel(lines, size);
}

chart::Panel stretch_panel(const study::StreamResult& result, const study::AxisResult& axis,
                           chart::PlotSize size) {
  const Stretch stretch = stretch_of(axis, result.rate_hz, kStretchRows);
  const std::string time_label = stretch.origin_s == 0.0
                                     ? "time in s"
                                     : fmt::format("time in s after {:.0f} s", stretch.origin_s);
  chart::Figure figure(size, {time_label, chart::range_of(parts(stretch.truth, &chart::Point::x))},
                       {short_name(axis) + ", log's own unit",
                        common_range(parts(stretch.truth, &chart::Point::y),
                                     parts(stretch.predicted, &chart::Point::y))},
                       axis.name + ": held-out rows, true and predicted, over time");
  const auto add = [&](const std::vector<chart::Point>& points, std::size_t style,
                       const char* name) {
    stretch.scattered ? figure.markers(points, style, name) : figure.line(points, style, name);
  };
  add(stretch.truth, kTruth, "true");
  add(stretch.predicted, kPredicted, "predicted");
  const std::string gaps = stretch.scattered ? "they stand alone in time, so they are not joined"
                                             : "gaps in time are not joined";
  return {figure.svg(),
          fmt::format("{} of {} held-out rows, in the log's own unit; {}.",
                      chart::grouped(static_cast<std::int64_t>(
                          std::min(kStretchRows, axis.held_out_true.size()))),
                      chart::grouped(static_cast<std::int64_t>(axis.held_out_true.size())), gaps)};
}

chart::Panel scatter_panel(const study::AxisResult& axis, chart::PlotSize size) {
  const std::vector<chart::Point> points = scatter_of(axis, kMostDots);
  const chart::Extent range =
      common_range(parts(points, &chart::Point::x), parts(points, &chart::Point::y));
  chart::Figure figure(size, {"true", range}, {"predicted", range},
                       axis.name + ": predicted against true value of held-out rows");
  if (!points.empty()) {
    figure.reference({range.low, range.low}, {range.high, range.high});
  }
  figure.dots(points, 0, "");
  return {figure.svg(),
          fmt::format("{} of {} held-out rows, evenly picked; on the dashed diagonal prediction "
                      "and truth agree.",
                      chart::grouped(static_cast<std::int64_t>(points.size())),
                      chart::grouped(static_cast<std::int64_t>(axis.held_out_true.size())))};
}

chart::Panel buffer_panel(const study::AxisResult& axis, chart::PlotSize size) {
  std::vector<chart::Point> buffer;
  std::vector<chart::Point> support_vectors;
  double most = kLeastCount;
  for (const study::ValidationPoint& point : axis.validation) {
    const auto samples = static_cast<double>(point.samples);
    buffer.push_back({samples, static_cast<double>(point.status.buffer)});
    support_vectors.push_back({samples, static_cast<double>(point.status.support_vectors)});
    most = largest({buffer.back().y, support_vectors.back().y}, most);
  }
  chart::Figure figure(size, {kStreamLabel, stream_range(axis)}, {"samples", {0.0, 1.05 * most}},
                       axis.name + ": buffer and support vectors over the stream");
  figure.line(buffer, 0, "buffer");
  figure.line(support_vectors, 1, "support vectors");
  mark_switches(figure, axis);
  return {figure.svg(), ""};
}

chart::Panel shares_panel(const study::AxisResult& axis, chart::PlotSize size) {
  constexpr std::array<std::size_t, 5> kColours{0, 4, 5, 3, 1};
  const std::vector<TallyField> fields = study::totals_of(TallyKind::arrival);
  std::vector<std::vector<chart::Box>> layers(fields.size());
  for (const Interval& interval : intervals_of(axis, kMostIntervals)) {
    std::int64_t total = 0;
    for (const TallyField& field : fields) {
      total += interval.done.*field.total;
    }
    double low = 0.0;
    for (std::size_t layer = 0; layer < layers.size() && total > 0; ++layer) {
      const auto count = static_cast<double>(interval.done.*fields[layer].total);
      const double high = low + 100.0 * count / static_cast<double>(total);
      layers[layer].push_back({interval.from, interval.to, low, high});
      low = high;
    }
  }
  chart::Figure figure(size, {kStreamLabel, stream_range(axis)}, {"share in %", {0.0, 100.0}},
                       axis.name + ": share of samples accepted and turned away over the stream");
  for (std::size_t layer = 0; layer < layers.size(); ++layer) {
    const bool rare =
        fields[layer].total == &Tally::invalid || fields[layer].total == &Tally::crowded_out;
    if (!rare || axis.status.tally.*fields[layer].total > 0) {
      figure.boxes(layers[layer], kColours[layer % kColours.size()],
                   std::string(fields[layer].label));
    }
  }
  return {figure.svg(), ""};
}

chart::Panel departures_panel(const study::AxisResult& axis, chart::PlotSize size) {
  constexpr std::array<std::size_t, 3> kColours{1, 0, 2};
  const std::vector<TallyField> fields = study::totals_of(TallyKind::departure);
  std::vector<std::vector<chart::Point>> curves(fields.size());
  double most = kLeastCount;
  for (const Interval& interval : intervals_of(axis, kMostIntervals)) {
    for (std::size_t i = 0; i < curves.size(); ++i) {
      curves[i].push_back({interval.to, static_cast<double>(interval.done.*fields[i].total)});
      most = largest({curves[i].back().y}, most);
    }
  }
  chart::Figure figure(size, {kStreamLabel, stream_range(axis)}, {"samples", {0.0, 1.05 * most}},
                       axis.name + ": samples that left the buffer over the stream");
  for (std::size_t i = 0; i < curves.size(); ++i) {
    figure.line(curves[i], kColours[i % kColours.size()], std::string(fields[i].label));
  }
  return {figure.svg(), ""};
}

chart::Panel coefficients_panel(const study::AxisResult& axis, chart::PlotSize size) {
  const std::vector<study::TermView> shown =
      study::most_effective(study::term_views(axis), kMostTermLines);
  std::vector<double> values{0.0};
  for (const study::TermView& view : shown) {
    values.insert(values.end(), view.effects.begin(), view.effects.end());
  }
  const std::string unit = axis.unit.empty() ? "the target's unit" : axis.unit;
  const chart::Extent range = stream_range(axis);
  chart::Figure figure(size, {kStreamLabel, range},
                       {"effect in " + unit, chart::widened(chart::range_of(values), 0.04)},
                       axis.name + ": effects of the physics terms over the stream");
  figure.reference({range.low, 0.0}, {range.high, 0.0});
  for (std::size_t i = 0; i < shown.size(); ++i) {
    figure.line(effect_curve(axis, shown[i]), i,
                chart::shortened(shown[i].term.formula, chart::kLongestName));
  }
  mark_switches(figure, axis);
  std::string caption =
      "Effect: a term's contribution at its root mean square over the training rows, in " + unit +
      ".";
  if (shown.size() < axis.terms.size()) {
    caption += fmt::format(" The {} largest of {} terms; all are in the table.", shown.size(),
                           axis.terms.size());
  }
  return {figure.svg(), caption};
}

}  // namespace kelpie::report
