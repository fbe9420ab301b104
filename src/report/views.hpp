// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "chart/figure.hpp"
#include "study/result.hpp"
#include "study/terms.hpp"

namespace kelpie::report {

// What the figures of a stream show, as data.

/// R² over samples shown; NaN where no model was in service.
std::vector<chart::Point> r2_curve(const study::AxisResult& axis);

/// The effect of one of the axis' terms over the samples shown.
std::vector<chart::Point> effect_curve(const study::AxisResult& axis, const study::TermView& term);

/// A place in the stream from which the vehicle ran in another configuration.
struct Switch {
  double samples = 0.0;
  int configuration = 0;
};
std::vector<Switch> switches(const study::AxisResult& axis);  ///< All of them, in their order.

/// A piece of the held-out rows that can be drawn over time, chosen by its place alone.
struct Stretch {
  std::vector<chart::Point> truth;  ///< x: seconds since `origin_s`; a break (NaN) at gaps in time
  std::vector<chart::Point> predicted;
  double origin_s = 0.0;   ///< 0, or a whole number of seconds where stamps are large
  bool scattered = false;  ///< rows stand alone in time: no lines, no breaks
};

/// Of all runs of `rows` held-out rows, one of those (the middle one) that span the least time. A
/// gap is a step longer than 1.5 times the rows' own distance: 1 / rate_hz, or the smallest step
/// where no rate is known.
Stretch stretch_of(const study::AxisResult& axis, double rate_hz, std::size_t rows);

/// Held-out rows as (true, predicted), evenly thinned to at most `most`, finite ones only.
std::vector<chart::Point> scatter_of(const study::AxisResult& axis, std::size_t most);

/// What the nodes did between two validation points (several where merged).
struct Interval {
  double from = 0.0;  ///< samples shown
  double to = 0.0;
  Tally done;  ///< difference of the totals, no negative numbers
};

/// The stream cut at its validation points, neighbours merged so that at most `most` are left.
std::vector<Interval> intervals_of(const study::AxisResult& axis, std::size_t most);

/// Update times counted in bins of a tenth of a decade; at least one decade.
struct TimeHistogram {
  chart::Extent range_us;  ///< first bin's lower and last bin's upper edge, low > 0
  std::vector<double> counts;
  std::size_t zeros = 0;  ///< times of 0 (below the clock's resolution), in the first bin
};
TimeHistogram histogram_of(const study::AxisResult& axis);  ///< Of all updates of an axis.

/// Lower and upper edge of bin `bin`.
chart::Extent bin_edges(const TimeHistogram& histogram, std::size_t bin);

}  // namespace kelpie::report
