// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "chart/figure.hpp"
#include "study/result.hpp"

namespace kelpie::report {

// What the figures of a stream show, as data.

/// The time axis of a page: it begins at 0, or where stamps are large at a whole number of seconds.
struct Clock {
  double origin_s = 0.0;
  chart::Extent shown{};  ///< from the first to the last row, since the origin

  chart::PlotAxis axis() const;
  double operator()(double time_s) const { return time_s - origin_s; }
};
Clock clock_of(const study::StreamResult& result);  ///< Of all figures of a page.

/// A series over time: x in seconds of the clock. Where two rows are further apart than 5 usual
/// steps, a NaN between them breaks the line.
std::vector<chart::Point> over_time(Clock clock, std::span<const double> time_s,
                                    std::span<const double> values);

/// Whether most rows stand alone in time, so that lines between them would say nothing.
bool scattered(std::span<const double> time_s);

/// A number of the validation points, over time.
template <typename Value>
std::vector<chart::Point> over_looks(Clock clock, const study::AxisResult& axis, Value value) {
  std::vector<chart::Point> curve;
  for (const study::ValidationPoint& look : axis.validation) {
    curve.push_back({clock(look.time_s), static_cast<double>(value(look))});
  }
  return curve;
}

/// The name of an axis as tables and figures show it.
std::string name_of(const study::AxisResult& axis);

/// A figure over time, with the window and the cursor of all such figures of its page.
chart::Figure figure_over_time(Clock clock, chart::PlotAxis y, const std::string& description);

/// A change of the vehicle: in the log (another configuration), or found by the learner.
struct Event {
  double time_s = 0.0;
  std::string name;
};
std::vector<Event> events_of(const study::AxisResult& axis);  ///< In the order of time.
void mark_events(chart::Figure& figure, const study::AxisResult& axis, Clock clock);

/// Held-out rows as (true, predicted), evenly thinned to at most `most`, finite ones only.
std::vector<chart::Point> scatter_of(const study::AxisResult& axis, std::size_t most);

/// What the nodes did between two validation points (several where merged).
struct Interval {
  double from_s = 0.0;
  double to_s = 0.0;
  Tally done;  ///< difference of the totals, no negative numbers
};

/// The stream cut at its validation points, neighbours merged so that at most `most` are left.
std::vector<Interval> intervals_of(const study::AxisResult& axis, std::size_t most);

/// Update times counted in bins of a tenth of a decade; at least one decade.
struct TimeHistogram {
  std::vector<chart::Point> bins;  ///< middle of each in µs, > 0; and how many
  std::size_t zeros = 0;           ///< times of 0 (below the clock's resolution), in the first bin
};
TimeHistogram histogram_of(const study::AxisResult& axis);  ///< Of all updates of an axis.

}  // namespace kelpie::report
