// SPDX-License-Identifier: Apache-2.0
#include "report/views.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "chart/wording.hpp"
#include "core/quantile.hpp"

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

// From one row of the log to the next, give or take its jitter.
double usual_step(std::span<const double> times) {
  std::vector<double> steps = steps_of(times);
  std::erase_if(steps, [](double step) { return !(step > 0.0); });
  return steps.empty() ? 0.0 : quantile(steps, 0.1);
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
  return {origin, {first - origin, last - origin}};
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
      events.push_back(
          {looks[i - 1].time_s, fmt::format("configuration {}", looks[i].configuration)});
    }
  }
  for (const study::ChangeFound& change : axis.changes) {
    events.push_back({change.time_s, change.recalled > 0 ? "known again" : "change found"});
  }
  std::ranges::stable_sort(events, {}, &Event::time_s);
  return events;
}

std::string name_of(const study::AxisResult& axis) {
  return chart::shortened(axis.name, chart::kLongestName);
}

chart::Figure figure_over_time(Clock clock, chart::PlotAxis y, const std::string& description) {
  chart::Figure figure(clock.axis(), std::move(y), description);
  figure.link("time");
  return figure;
}

void mark_events(chart::Figure& figure, const study::AxisResult& axis, Clock clock) {
  for (const Event& event : events_of(axis)) {
    figure.mark(clock(event.time_s), event.name);
  }
}

std::vector<chart::Point> scatter_of(const study::AxisResult& axis, std::size_t most) {
  std::vector<chart::Point> finite;
  const std::size_t rows = std::min(axis.held_out_true.size(), axis.held_out_predicted.size());
  for (std::size_t i = 0; i < rows; ++i) {
    const chart::Point point{axis.held_out_true[i], axis.held_out_predicted[i]};
    if (std::isfinite(point.x) && std::isfinite(point.y)) {
      finite.push_back(point);
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

}  // namespace kelpie::report
