// SPDX-License-Identifier: Apache-2.0
#include "report/stream_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <ranges>
#include <utility>
#include <vector>

#include "chart/wording.hpp"
#include "core/quantile.hpp"
#include "report/tuning.hpp"
#include "study/summary.hpp"
#include "study/terms.hpp"

namespace kelpie::report {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kBinsPerDecade = 10.0;
constexpr double kLargeStamp_s = 1e6;
constexpr double kGap = 5.5;  // steps: a single row held out here and there is no gap
constexpr double kAlone = 1.5;
constexpr double kScatteredShare = 0.2;  // of rows that stand alone

std::vector<double> steps_of(std::span<const double> times) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < times.size(); ++i) {
    steps.push_back(times[i] - times[i - 1]);
  }
  return steps;
}

// What nearly all values are in, with room: one wild value would flatten all others.
chart::Extent usual_range(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.empty()) {
    return {};
  }
  const double low = quantile(values, 0.005);
  const double high = quantile(values, 0.995);
  const double room = 2.0 * (high - low) + 1e-9 * std::abs(high);
  return {low - room, high + room};
}

// From one row of the log to the next, give or take its jitter.
double usual_step(std::span<const double> times) {
  std::vector<double> steps = steps_of(times);
  std::erase_if(steps, [](double step) { return !(step > 0.0); });
  return steps.empty() ? 0.0 : quantile(steps, 0.1);
}

// The first row of a configuration that the look before did not see, held-out rows included: the
// vehicle often changes within a held-out block.
double first_row(const study::AxisResult& axis, double before_s,
                 const study::ValidationPoint& look) {
  double first = look.time_s;
  const auto take = [&](double time_s) {
    first = time_s > before_s ? std::min(first, time_s) : first;
  };
  const study::OneStep& steps = axis.one_step;
  for (std::size_t i = 0; i < steps.configuration.size(); ++i) {
    if (steps.configuration[i] == look.configuration) {
      take(steps.time_s[i]);
    }
  }
  for (const study::StageEnd& stage : axis.stages) {
    if (stage.configuration == look.configuration) {
      std::ranges::for_each(stage.time_s, take);
    }
  }
  return first;
}

// Standard deviation over the rows of a window, wild values bounded.
double motion_in(const study::OneStep& steps, chart::Extent usual, std::size_t begin,
                 std::size_t end) {
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = begin; i < end; ++i) {
    const double value = std::clamp(steps.truth[i], usual.low, usual.high);
    sum += value;
    squares += value * value;
  }
  const auto count = static_cast<double>(end - begin);
  return begin == end ? 0.0 : std::sqrt(std::max(0.0, squares / count - sum / count * sum / count));
}

// Around the last named change, most of it after the change; else the stretch of the later half in
// which the first axis moves most. All rows where they are few.
chart::Extent first_window(const study::StreamResult& result, chart::Extent all) {
  const study::OneStep* const steps = result.axes.empty() ? nullptr : &result.axes.front().one_step;
  if (steps == nullptr || steps->time_s.empty()) {
    return all;
  }
  const double width =
      std::max(kTuning.first_window_s, kTuning.first_window_rows * usual_step(steps->time_s));
  if (!(all.high - all.low > 2.0 * width)) {
    return all;
  }
  for (const Finding& finding : std::views::reverse(result.diagnosis.findings)) {
    if (finding.state == FindingState::named) {
      const double from =
          std::clamp(finding.since_s - kTuning.before_change * width, all.low, all.high - width);
      return {from, from + width};
    }
  }
  const chart::Extent usual = usual_range(steps->truth);
  const std::vector<double>& times = steps->time_s;
  double most = -1.0;
  double best = all.high - width;
  auto begin = std::ranges::lower_bound(times, std::midpoint(all.low, all.high));
  while (begin != times.end() && *begin + width < all.high) {
    const double from = *begin;
    const auto end = std::lower_bound(begin, times.end(), from + width);
    // Held-out rows leave holes: a window half empty tells less, however lively.
    const double motion = static_cast<double>(end - begin) *
                          motion_in(*steps, usual, static_cast<std::size_t>(begin - times.begin()),
                                    static_cast<std::size_t>(end - times.begin()));
    if (motion > most) {
      most = motion;
      best = from;
    }
    begin = std::lower_bound(std::next(begin), times.end(), from + 0.5 * width);
  }
  return {best, best + width};
}

Tally difference(const Tally& before, const Tally& after) {
  Tally gained;
  for (const TallyField& field : tally_fields()) {
    const std::int64_t more = after.*field.total - before.*field.total;
    gained.*field.total = std::max<std::int64_t>(0, more);
  }
  return gained;
}

}  // namespace

chart::PlotAxis Clock::axis() const {
  return {origin_s == 0.0 ? "time in s" : fmt::format("time in s after {:.0f} s", origin_s), shown};
}

Clock clock_of(const study::StreamResult& result) {
  std::vector<double> ends;
  for (const study::AxisResult& axis : result.axes) {
    for (const std::vector<double>* times : {&axis.one_step.time_s, &axis.held_out_time_s}) {
      if (!times->empty()) {
        ends.insert(ends.end(), {times->front(), times->back()});
      }
    }
    if (!axis.validation.empty()) {
      ends.insert(ends.end(), {axis.validation.front().time_s, axis.validation.back().time_s});
    }
  }
  const auto [first, last] = chart::range_of(ends);
  const double origin = std::abs(first) > kLargeStamp_s ? std::floor(first) : 0.0;
  const auto [from, to] = first_window(result, {first, last});
  return {origin, {first - origin, last - origin}, {from - origin, to - origin}};
}

std::vector<chart::Point> over_time(Clock clock, std::span<const double> time_s,
                                    std::span<const double> values) {
  std::vector<chart::Point> points;
  const double longest = kGap * usual_step(time_s);
  for (std::size_t i = 0; i < std::min(time_s.size(), values.size()); ++i) {
    if (i > 0 && time_s[i] - time_s[i - 1] > longest) {
      points.push_back({clock(0.5 * (time_s[i - 1] + time_s[i])), kNan});
    }
    points.push_back({clock(time_s[i]), values[i]});
  }
  return points;
}

bool scattered(std::span<const double> time_s) {
  const std::vector<double> steps = steps_of(time_s);
  const double longest = kAlone * usual_step(time_s);
  const auto gaps = std::ranges::count_if(steps, [&](double step) { return step > longest; });
  return static_cast<double>(gaps) > kScatteredShare * static_cast<double>(time_s.size());
}

std::vector<Event> events_of(const study::AxisResult& axis) {
  std::vector<Event> events;
  const std::vector<study::ValidationPoint>& looks = axis.validation;
  for (std::size_t i = 1; i < looks.size(); ++i) {
    if (looks[i].configuration != looks[i - 1].configuration) {
      events.push_back({first_row(axis, looks[i - 1].time_s, looks[i]),
                        fmt::format("configuration {}", looks[i].configuration)});
    }
  }
  for (const study::ChangeFound& change : axis.changes) {
    events.push_back({change.since_s, change.recalled > 0 ? "known again" : "change"});
  }
  std::ranges::stable_sort(events, {}, &Event::time_s);
  return events;
}

std::string name_of(const study::AxisResult& axis) {
  return chart::shortened(axis.name, chart::kLongestName);
}

chart::Figure figure_over_time(const Clock& clock, const chart::PlotAxis& y,
                               const std::string& description) {
  chart::Figure figure(clock.axis(), y, description);
  figure.link("stream");
  return figure;
}

void mark_events(chart::Figure& figure, const study::AxisResult& axis, Clock clock) {
  for (const Event& event : events_of(axis)) {
    figure.mark(clock(event.time_s), event.name);
  }
}

namespace {

// Whether R² at the end counts a held-out row.
bool is_of_last_configuration(const study::AxisResult& axis, std::size_t row) {
  return axis.stages.empty() || row >= axis.held_out_time_s.size() ||
         std::ranges::binary_search(axis.stages.back().time_s, axis.held_out_time_s[row]);
}

}  // namespace

std::vector<ScatterDot> scatter_of(const study::AxisResult& axis, std::size_t most) {
  std::vector<ScatterDot> finite;
  const std::size_t rows = std::min(axis.held_out_true.size(), axis.held_out_predicted.size());
  for (std::size_t i = 0; i < rows; ++i) {
    const chart::Point point{axis.held_out_true[i], axis.held_out_predicted[i]};
    if (std::isfinite(point.x) && std::isfinite(point.y)) {
      finite.push_back({point, is_of_last_configuration(axis, i)});
    }
  }
  const std::size_t kept = std::min(most, finite.size());
  for (std::size_t i = 0; i < kept; ++i) {
    finite[i] = finite[i * finite.size() / kept];
  }
  finite.resize(kept);
  return finite;
}

std::vector<Interval> intervals_of(const study::AxisResult& axis, std::size_t most) {
  std::vector<Interval> intervals;
  const std::vector<study::ValidationPoint>& points = axis.validation;
  const std::size_t count = std::min(most, points.size());
  Tally before;
  double from = points.empty() ? 0.0 : points.front().time_s;
  for (std::size_t i = 1; i <= count; ++i) {
    const study::ValidationPoint& point = points[i * points.size() / count - 1];
    intervals.push_back({from, point.time_s, difference(before, point.status.tally)});
    before = point.status.tally;
    from = point.time_s;
  }
  return intervals;
}

TimeHistogram histogram_of(const study::AxisResult& axis) {
  std::vector<double> positive;
  TimeHistogram histogram;
  for (const double time : axis.update_us) {
    if (std::isfinite(time) && time > 0.0) {
      positive.push_back(time);
    } else if (time <= 0.0) {
      ++histogram.zeros;
    }
  }
  if (positive.empty() && histogram.zeros == 0) {
    return histogram;
  }
  const chart::Extent range =
      positive.empty() ? chart::Extent{1.0, 1.0} : chart::range_of(positive);
  const double first = std::floor(kBinsPerDecade * std::log10(range.low));
  const double last =
      std::max(first + kBinsPerDecade, std::floor(kBinsPerDecade * std::log10(range.high)) + 1.0);
  for (double bin = first; bin < last; ++bin) {
    histogram.bins.push_back({std::pow(10.0, (bin + 0.5) / kBinsPerDecade), 0.0});
  }
  for (const double time : positive) {
    ++histogram
          .bins[static_cast<std::size_t>(std::floor(kBinsPerDecade * std::log10(time)) - first)]
          .y;
  }
  histogram.bins.front().y += static_cast<double>(histogram.zeros);
  return histogram;
}

namespace {

constexpr std::size_t kMostDots = 1500;
constexpr std::size_t kMostIntervals = 60;

// Styles that mean the same in every figure.
constexpr std::size_t kTruth = 0;
constexpr std::size_t kPredicted = 1;
constexpr std::size_t kOutlier = 3;

std::string unit_of(const study::AxisResult& axis) {
  return axis.unit.empty() ? "the log's own unit" : chart::unit_text(axis.unit);
}

// Of single samples.
chart::Figure figure_of_samples(Clock clock, const study::AxisResult& axis,
                                const std::string& description) {
  return {clock.axis(), {name_of(axis) + " in " + unit_of(axis)}, description};
}

// As long as the clock's first window, and this window where there are held-out rows in it: of
// blocks or pieces there are often none.
chart::Extent held_out_window(const study::AxisResult& axis, Clock clock) {
  const auto after = std::ranges::lower_bound(axis.held_out_time_s, clock.first.low, {}, clock);
  if (axis.held_out_time_s.empty() ||
      (after != axis.held_out_time_s.end() && clock(*after) < clock.first.high)) {
    return clock.first;
  }
  const double length = clock.first.high - clock.first.low;
  const double from = after != axis.held_out_time_s.end()
                          ? clock(*after)
                          : clock(axis.held_out_time_s.back()) - length;
  return {from, from + length};
}

std::size_t clip(std::vector<chart::Point>& points, chart::Extent range) {
  std::size_t clipped = 0;
  for (chart::Point& point : points) {
    if (point.y < range.low || point.y > range.high) {
      point.y = std::clamp(point.y, range.low, range.high);
      ++clipped;
    }
  }
  return clipped;
}

std::vector<double> halves(const study::OneStep& steps) {
  std::vector<double> half;
  for (std::size_t i = 0; i < steps.upper.size(); ++i) {
    half.push_back(0.5 * (steps.upper[i] - steps.lower[i]));
  }
  return half;
}

std::vector<double> values_of(const std::vector<chart::Point>& points) {
  std::vector<double> values;
  for (const chart::Point& point : points) {
    values.push_back(point.y);
  }
  return values;
}

// Totals of one kind between validation points, a line each: how many, or their shares.
std::string tally_figure(chart::Figure figure, const study::AxisResult& axis, Clock clock,
                         TallyKind kind, bool shares) {
  const std::vector<TallyField> fields = study::totals_of(kind);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    std::vector<chart::Point> curve;
    for (const Interval& interval : intervals_of(axis, kMostIntervals)) {
      double all = 0.0;
      for (const TallyField& field : fields) {
        all += static_cast<double>(interval.done.*field.total);
      }
      curve.push_back({clock(interval.to_s), static_cast<double>(interval.done.*fields[i].total) *
                                                 (shares ? 100.0 / all : 1.0)});
    }
    if (axis.status.tally.*fields[i].total > 0) {
      figure.line(curve, i, std::string(fields[i].label));
    }
  }
  mark_events(figure, axis, clock);
  return figure.html();
}

}  // namespace

std::string course_figure(const study::AxisResult& axis, Clock clock) {
  const study::OneStep& steps = axis.one_step;
  const chart::Extent usual = usual_range(steps.truth);
  std::vector<chart::Point> truth = over_time(clock, steps.time_s, steps.truth);
  std::vector<chart::Point> predicted = over_time(clock, steps.time_s, steps.predicted);
  std::vector<chart::Point> outliers;
  for (const study::OutliersFound& found : axis.outliers) {
    outliers.push_back({clock(found.time_s), found.target});
  }
  const std::size_t clipped = clip(truth, usual) + clip(predicted, usual);
  clip(outliers, usual);
  chart::Figure figure = figure_of_samples(
      clock, axis,
      axis.name + ": every sample as measured and as predicted just before it was learned");
  figure.link("time");
  figure.begin_at(clock.first);
  figure.band(predicted, values_of(over_time(clock, steps.time_s, halves(steps))), kPredicted,
              "interval");
  figure.line(truth, kTruth, "measured");
  figure.line(predicted, kPredicted, "predicted");
  figure.markers(outliers, kOutlier, "outliers removed");
  figure.errors_below("measured", "predicted",
                      axis.unit.empty() ? "error" : "error in " + unit_of(axis));
  mark_events(figure, axis, clock);
  return figure.html(clipped == 0 ? ""
                                  : chart::grouped(clipped) +
                                        " values far outside the others are drawn at the edge.");
}

std::string r2_figure(const std::vector<R2Line>& lines, Clock clock) {
  std::vector<std::vector<chart::Point>> curves;
  std::size_t clipped = 0;
  double low = 0.8;
  double lowest = 0.0;
  std::string whose;
  for (const R2Line& line : lines) {
    curves.push_back(over_looks(clock, *line.axis, study::served_r2));
    for (const double value : values_of(curves.back())) {
      low = std::fmin(low, std::floor(5.0 * value) / 5.0);
      clipped += value < kTuning.lowest_r2 ? 1 : 0;
      if (value < lowest) {
        lowest = value;
        whose = line.name;
      }
    }
  }
  chart::Figure figure = figure_over_time(
      clock, {"R² on held-out rows", chart::Extent{std::max(low, kTuning.lowest_r2), 1.0}},
      "Validation R² over the stream");
  for (std::size_t i = 0; i < lines.size(); ++i) {
    figure.line(curves[i], i, lines[i].name);
  }
  if (!lines.empty()) {
    mark_events(figure, *lines.front().axis, clock);
  }
  std::string caption =
      "R² on the held-out rows of the configuration then running; 1 is perfect, 0 is no better "
      "than always predicting their mean.";
  if (clipped > 0) {
    caption += fmt::format(" {} points lie below the figure, the lowest at {} ({}).",
                           chart::grouped(clipped), chart::decimal(lowest), whose);
  }
  return figure.html(caption);
}

std::string r2_figure(const study::StreamResult& result, Clock clock) {
  std::vector<R2Line> lines;
  lines.reserve(result.axes.size());
  for (const study::AxisResult& axis : result.axes) {
    lines.push_back({name_of(axis), &axis});
  }
  return r2_figure(lines, clock);
}

std::string held_out_figure(const study::AxisResult& axis, Clock clock) {
  chart::Figure figure =
      figure_of_samples(clock, axis, axis.name + ": held-out rows, true and predicted, over time");
  figure.link("held_out");
  figure.begin_at(held_out_window(axis, clock));
  const bool alone = scattered(axis.held_out_time_s);
  const auto add = [&](const std::vector<double>& values, std::size_t style, const char* name) {
    const std::vector<chart::Point> points = over_time(clock, axis.held_out_time_s, values);
    alone ? figure.markers(points, style, name) : figure.line(points, style, name);
  };
  add(axis.held_out_true, kTruth, "true");
  add(axis.held_out_predicted, kPredicted, "predicted");
  mark_events(figure, axis, clock);
  return figure.html(fmt::format(
      "{} held-out rows; {}.", chart::grouped(axis.held_out_true.size()),
      alone ? "they stand alone in time, so they are not joined" : "gaps in time are not joined"));
}

std::string scatter_figure(const study::AxisResult& axis) {
  std::vector<chart::Point> counted;
  std::vector<chart::Point> earlier;
  std::vector<double> all;
  for (const ScatterDot& dot : scatter_of(axis, kMostDots)) {
    (dot.is_counted ? counted : earlier).push_back(dot);
    all.insert(all.end(), {dot.x, dot.y});
  }
  const auto [low, high] = chart::range_of(all);
  const double room = std::max(0.04 * (high - low), 1e-9);
  const chart::Extent range{low - room, high + room};
  chart::Figure figure({"true, in " + unit_of(axis), range},
                       {"predicted, in " + unit_of(axis), range},
                       axis.name + ": predicted against true value of held-out rows");
  figure.make_square();
  const bool several = !earlier.empty();
  figure.dots(earlier, kPredicted, several ? "earlier" : "");
  figure.dots(counted, kTruth, several ? "last" : "held-out row");
  figure.reference({range.low, range.low}, {range.high, range.high});
  const std::size_t shown = counted.size() + earlier.size();
  const std::size_t rows = axis.held_out_true.size();
  return figure.html((shown < rows ? fmt::format("{} of {} held-out rows, evenly picked",
                                                 chart::grouped(shown), chart::grouped(rows))
                                   : fmt::format("{} held-out rows", chart::grouped(rows))) +
                     "; on the dashed diagonal prediction and truth agree." +
                     (several ? " R² counts the last configuration alone." : ""));
}

std::string coverage_figure(const study::StreamResult& result, Clock clock) {
  chart::Figure figure = figure_over_time(clock, {"share inside their interval, in %"},
                                          "Share of samples inside their interval");
  for (std::size_t i = 0; i < result.axes.size(); ++i) {
    const study::AxisResult& axis = result.axes[i];
    std::vector<double> shares = study::running_coverage(axis.one_step);
    std::ranges::transform(shares, shares.begin(), [](double share) { return 100.0 * share; });
    figure.line(over_time(clock, axis.one_step.time_s, shares), i, name_of(axis));
  }
  if (!result.axes.empty()) {
    mark_events(figure, result.axes.front(), clock);
  }
  return figure.html(
      "Share of the last 500 samples of the same configuration that were inside the interval in "
      "force before they were learned.");
}

std::string novelty_figure(const study::AxisResult& axis) {
  std::vector<chart::Point> bars;
  std::size_t rows = 0;
  for (const study::NoveltyBin& bin : axis.novelty) {
    if (bin.rows > 0) {
      bars.push_back({0.5 * (bin.from + bin.to), bin.rms_error});
      rows += bin.rows;
    }
  }
  chart::Figure figure({"novelty", chart::Extent{0.0, 1.0}}, {"error (RMS) in " + unit_of(axis)},
                       axis.name + ": error on held-out rows by novelty");
  figure.bars(bars, kTruth, "error");
  return figure.html(chart::grouped(rows) +
                     " held-out rows by the model at the end of the stream.");
}

std::string buffer_figure(const study::AxisResult& axis, Clock clock) {
  chart::Figure figure = figure_over_time(
      clock, {"samples"}, axis.name + ": buffer and support vectors over the stream");
  figure.line(over_looks(clock, axis, [](const auto& look) { return look.status.buffer; }), 0,
              "buffer");
  figure.line(over_looks(clock, axis, [](const auto& look) { return look.status.support_vectors; }),
              1, "support vectors");
  mark_events(figure, axis, clock);
  return figure.html();
}

std::string shares_figure(const study::AxisResult& axis, Clock clock) {
  return tally_figure(
      figure_over_time(clock, {"share of the samples in %", chart::Extent{0.0, 100.0}},
                       axis.name + ": samples accepted and turned away over the stream"),
      axis, clock, TallyKind::arrival, true);
}

std::string departures_figure(const study::AxisResult& axis, Clock clock) {
  return tally_figure(
      figure_over_time(clock, {"samples"},
                       axis.name + ": samples that left the buffer over the stream"),
      axis, clock, TallyKind::departure, false);
}

namespace {

constexpr std::size_t kMostTermLines = 7;  // as many as there are colours

std::string formula_of(const study::TermView& view) {
  return chart::shortened(view.term.formula, chart::kLongestName);
}

// A series of the looks, and its standard error.
struct TermLine {
  std::string name;
  std::vector<chart::Point> curve{};
  std::vector<double> errors{};
};

// Each number times a factor.
TermLine term_line(const study::AxisResult& axis, const study::TermView& view, double factor,
                   Clock clock) {
  TermLine line{formula_of(view)};
  for (std::size_t i = 0; i < axis.validation.size(); ++i) {
    line.curve.push_back({clock(axis.validation[i].time_s), factor * view.values[i]});
    line.errors.push_back(std::abs(factor) * view.errors[i]);
  }
  return line;
}

// What most values with their errors are in, with as much room, and all values of the later half;
// empty where nothing lies outside. The first looks are often far off, and would flatten the rest.
std::optional<chart::Extent> settled_range(const std::vector<TermLine>& lines) {
  std::vector<double> all;
  std::vector<double> late;
  for (const TermLine& line : lines) {
    for (std::size_t i = 0; i < line.curve.size(); ++i) {
      const double value = line.curve[i].y;
      const double error = std::isfinite(line.errors[i]) ? line.errors[i] : 0.0;
      if (std::isfinite(value)) {
        all.insert(all.end(), {value - error, value + error});
        if (2 * i >= line.curve.size()) {
          late.push_back(value);
        }
      }
    }
  }
  if (all.empty() || late.empty()) {
    return std::nullopt;
  }
  const double low = quantile(all, 0.1);
  const double high = quantile(all, 0.9);
  const auto [least, greatest] = chart::range_of(late);
  const chart::Extent range{std::min(2.0 * low - high, least),
                            std::max(2.0 * high - low, greatest)};
  const auto [lowest, highest] = chart::range_of(all);
  return range.low < range.high && (lowest < range.low || highest > range.high)
             ? std::optional(range)
             : std::nullopt;
}

// A figure of the lines, and what to say of values outside.
std::pair<chart::Figure, std::string> terms_figure(const std::vector<TermLine>& lines,
                                                   std::size_t first_style,
                                                   const std::string& y_label,
                                                   const std::string& description,
                                                   const study::AxisResult& axis, Clock clock) {
  const std::optional<chart::Extent> range = settled_range(lines);
  chart::Figure figure = figure_over_time(clock, {y_label, range}, description);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    figure.band(lines[i].curve, lines[i].errors, first_style + i);
    figure.line(lines[i].curve, first_style + i, lines[i].name);
  }
  mark_events(figure, axis, clock);
  return {std::move(figure), range ? "Values far outside the others are cut off." : ""};
}

}  // namespace

std::string effects_figure(const study::AxisResult& axis, Clock clock) {
  const std::vector<study::TermView> shown =
      study::most_effective(study::term_views(axis), kMostTermLines);
  const std::string unit = axis.unit.empty() ? "the target's unit" : chart::unit_text(axis.unit);
  std::vector<TermLine> lines;
  for (const study::TermView& view : shown) {
    lines.push_back(term_line(axis, view, view.term.rms, clock));
  }
  const auto& [figure, outside] =
      terms_figure(lines, 0, "effect in " + unit,
                   axis.name + ": effects of the physics terms over the stream", axis, clock);
  std::string caption =
      "Effect: a term's contribution at its root mean square over the training rows, in " + unit +
      ". Shaded: ± one standard error.";
  if (shown.size() < axis.terms.size()) {
    caption += fmt::format(" The {} largest of {} terms; all are in result.json.", shown.size(),
                           axis.terms.size());
  }
  return figure.html(caption + (outside.empty() ? "" : " " + outside));
}

std::vector<std::string> coefficient_figures(const study::AxisResult& axis, Clock clock) {
  std::vector<std::string> figures;
  for (const study::TermView& view :
       study::most_effective(study::term_views(axis), kMostTermLines)) {
    const std::string unit =
        view.term.unit.empty() ? "the log's units" : chart::unit_text(view.term.unit);
    const auto& [figure, outside] =
        terms_figure({term_line(axis, view, 1.0, clock)}, figures.size(), "coefficient in " + unit,
                     axis.name + ": coefficient of " + view.term.formula, axis, clock);
    figures.push_back(figure.html(outside));
  }
  return figures;
}

std::string timing_figure(const study::AxisResult& axis) {
  const TimeHistogram histogram = histogram_of(axis);
  chart::Figure figure({"update time in µs", {}, chart::ScaleKind::logarithmic}, {"updates"},
                       axis.name + ": histogram of update times");
  figure.bars(histogram.bins, 0, "updates");
  const study::Quantiles times = study::quantiles_of(axis.update_us);
  figure.mark(times.median, "median " + chart::duration(times.median));
  figure.mark(times.p99, "p99 " + chart::duration(times.p99));
  return figure.html(
      histogram.zeros == 0
          ? ""
          : fmt::format("{} update{} of 0 µs (below the clock's resolution) counted in the first "
                        "bin.",
                        chart::grouped(histogram.zeros), histogram.zeros == 1 ? "" : "s"));
}

}  // namespace kelpie::report
