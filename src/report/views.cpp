// SPDX-License-Identifier: Apache-2.0
#include "report/views.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "study/summary.hpp"

namespace kelpie::report {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kBinsPerDecade = 10.0;
constexpr double kLargeStamp_s = 1e6;
constexpr double kGapFactor = 1.5;
constexpr double kScatteredShare = 0.2;  // of steps that are gaps: beyond it lines say nothing

std::size_t held_out_rows(const study::AxisResult& axis) {
  return std::min(
      {axis.held_out_time_s.size(), axis.held_out_true.size(), axis.held_out_predicted.size()});
}

// First row of the middle one among the runs of `rows` rows that span (nearly) the least time.
std::size_t densest_run(std::span<const double> times, std::size_t rows) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + rows <= times.size(); ++i) {
    least = std::min(least, times[i + rows - 1] - times[i]);
  }
  std::vector<std::size_t> candidates;
  for (std::size_t i = 0; i + rows <= times.size(); ++i) {
    if (times[i + rows - 1] - times[i] <= 1.01 * least) {
      candidates.push_back(i);
    }
  }
  return candidates.empty() ? 0 : candidates[candidates.size() / 2];
}

double row_distance(std::span<const double> times, double rate_hz) {
  if (std::isfinite(rate_hz) && rate_hz > 0.0) {
    return 1.0 / rate_hz;
  }
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (const double step = times[i] - times[i - 1]; step > 0.0) {
      least = std::min(least, step);
    }
  }
  return least;
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

std::vector<chart::Point> r2_curve(const study::AxisResult& axis) {
  std::vector<chart::Point> curve;
  curve.reserve(axis.validation.size());
  for (const study::ValidationPoint& point : axis.validation) {
    curve.push_back({static_cast<double>(point.samples), study::served_r2(point)});
  }
  return curve;
}

std::vector<chart::Point> effect_curve(const study::AxisResult& axis, const study::TermView& term) {
  std::vector<chart::Point> curve;
  std::ranges::transform(axis.validation, term.effects, std::back_inserter(curve),
                         [](const study::ValidationPoint& look, double effect) {
                           return chart::Point{static_cast<double>(look.samples), effect};
                         });
  return curve;
}

std::vector<Switch> switches(const study::AxisResult& axis) {
  std::vector<Switch> found;
  const std::vector<study::ValidationPoint>& points = axis.validation;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (points[i].configuration != points[i - 1].configuration) {
      found.push_back({static_cast<double>(points[i - 1].samples), points[i].configuration});
    }
  }
  return found;
}

Stretch stretch_of(const study::AxisResult& axis, double rate_hz, std::size_t rows) {
  Stretch stretch;
  const std::span<const double> all(axis.held_out_time_s.data(), held_out_rows(axis));
  if (all.empty()) {
    return stretch;
  }
  rows = std::min(rows, all.size());
  const std::size_t first = densest_run(all, rows);
  const std::span<const double> times = all.subspan(first, rows);
  const double longest_step = kGapFactor * row_distance(times, rate_hz);
  const auto is_gap = [&](std::size_t i) {
    return i > 0 && times[i] - times[i - 1] > longest_step;
  };
  std::size_t gaps = 0;
  for (std::size_t i = 0; i < rows; ++i) {
    gaps += is_gap(i) ? 1U : 0U;
  }
  stretch.scattered = static_cast<double>(gaps) > kScatteredShare * static_cast<double>(rows);
  stretch.origin_s = std::abs(times.front()) > kLargeStamp_s ? std::floor(times.front()) : 0.0;
  for (std::size_t i = 0; i < rows; ++i) {
    const double time = times[i] - stretch.origin_s;
    if (is_gap(i) && !stretch.scattered) {
      stretch.truth.push_back({time, kNan});
      stretch.predicted.push_back({time, kNan});
    }
    stretch.truth.push_back({time, axis.held_out_true[first + i]});
    stretch.predicted.push_back({time, axis.held_out_predicted[first + i]});
  }
  return stretch;
}

std::vector<chart::Point> scatter_of(const study::AxisResult& axis, std::size_t most) {
  std::vector<chart::Point> finite;
  for (std::size_t i = 0; i < held_out_rows(axis); ++i) {
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
  double from = 0.0;
  for (std::size_t i = 1; i <= count; ++i) {
    const study::ValidationPoint& point = points[i * points.size() / count - 1];
    const auto to = static_cast<double>(point.samples);
    intervals.push_back({from, to, difference(before, point.status.tally)});
    before = point.status.tally;
    from = to;
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
  const chart::Extent range =
      positive.empty() ? chart::Extent{1.0, 1.0} : chart::range_of(positive);
  const double first = std::floor(kBinsPerDecade * std::log10(range.low));
  const double last =
      std::max(first + kBinsPerDecade, std::floor(kBinsPerDecade * std::log10(range.high)) + 1.0);
  histogram.range_us = {std::pow(10.0, first / kBinsPerDecade),
                        std::pow(10.0, last / kBinsPerDecade)};
  if (positive.empty() && histogram.zeros == 0) {
    return histogram;
  }
  histogram.counts.assign(static_cast<std::size_t>(last - first), 0.0);
  for (const double time : positive) {
    ++histogram
          .counts[static_cast<std::size_t>(std::floor(kBinsPerDecade * std::log10(time)) - first)];
  }
  histogram.counts.front() += static_cast<double>(histogram.zeros);
  return histogram;
}

chart::Extent bin_edges(const TimeHistogram& histogram, std::size_t bin) {
  const double first = std::log10(histogram.range_us.low);
  const auto place = static_cast<double>(bin);
  return {std::pow(10.0, first + place / kBinsPerDecade),
          std::pow(10.0, first + (place + 1.0) / kBinsPerDecade)};
}

}  // namespace kelpie::report
