// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "chart/figure.hpp"
#include "study/result.hpp"

namespace kelpie::report {

// The data of the figures of a stream.

/// The time axis of a page. The origin is 0, or for large stamps a whole number of seconds.
struct Clock {
  double origin_s = 0.0;
  chart::Extent shown{};  ///< from the first to the last row, since the origin
  chart::Extent first{};  ///< a minute or so to begin with, where all rows are too many

  chart::PlotAxis axis() const;
  double operator()(double time_s) const { return time_s - origin_s; }
};
Clock clock_of(const study::StreamResult& result);  ///< Shared by the figures of a page.

/// A series over time: x in seconds of the clock. A NaN breaks the line between two rows more than
/// 5 median steps apart.
std::vector<chart::Point> over_time(Clock clock, std::span<const double> time_s,
                                    std::span<const double> values);

/// Whether most rows have no neighbours in time; lines between such rows would mislead.
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

/// The name of an axis in tables and figures.
std::string name_of(const study::AxisResult& axis);

/// A figure over the stream; those of a page share window and cursor.
chart::Figure figure_over_time(const Clock& clock, const chart::PlotAxis& y,
                               const std::string& description);

/// A change of the vehicle: another configuration in the log, or a detected change.
struct Event {
  double time_s = 0.0;  ///< of its first row; of a detected change, when errors began to grow
  std::string name;
};
std::vector<Event> events_of(const study::AxisResult& axis);  ///< In the order of time.
void mark_events(chart::Figure& figure, const study::AxisResult& axis, Clock clock);

/// A held-out row as (true, predicted).
struct ScatterDot : chart::Point {
  bool is_counted = true;  ///< by R² at the end: a row of the last configuration
};

/// Finite held-out rows, evenly thinned to at most `most`.
std::vector<ScatterDot> scatter_of(const study::AxisResult& axis, std::size_t most);

/// Counts of the nodes between two validation points, or several merged points.
struct Interval {
  double from_s = 0.0;
  double to_s = 0.0;
  Tally done;  ///< difference of the totals, never negative
};

/// The stream cut at its validation points; neighbours are merged down to `most` intervals.
std::vector<Interval> intervals_of(const study::AxisResult& axis, std::size_t most);

/// Update times counted in bins of a tenth of a decade; at least one decade.
struct TimeHistogram {
  std::vector<chart::Point> bins;  ///< middle of each in µs, > 0; and how many
  std::size_t zeros = 0;           ///< times of 0 (below the clock's resolution), in the first bin
};
TimeHistogram histogram_of(const study::AxisResult& axis);  ///< Of every update of an axis.

// Figures of a stream, as HTML. Figures of samples share a window and a cursor, which begins with
// Clock::first; so do the figures over the whole stream.

/// The run of an axis: each sample as measured and as predicted before learning, with the interval
/// of the prediction, and the errors below; changes and outliers.
std::string course_figure(const study::AxisResult& axis, Clock clock);

/// A line of r2_figure().
struct R2Line {
  std::string name;
  const study::AxisResult* axis = nullptr;
};

/// Validation R² over time, in the order of the lines. The figure ends at −0.2; the caption counts
/// the points below. Changes in the log and detected changes are marked.
std::string r2_figure(const std::vector<R2Line>& lines, Clock clock);
std::string r2_figure(const study::StreamResult& result, Clock clock);  ///< Of every axis.

/// Held-out rows over time: true, and predicted by the final model of the stream.
std::string held_out_figure(const study::AxisResult& axis, Clock clock);

/// Predicted against true, held-out rows (thinned).
std::string scatter_figure(const study::AxisResult& axis);

/// Share of samples inside their interval, over windows of kCoverageWindow samples, of every axis.
std::string coverage_figure(const study::StreamResult& result, Clock clock);

/// Error on held-out rows by novelty.
std::string novelty_figure(const study::AxisResult& axis);

/// Buffer and support vectors over time.
std::string buffer_figure(const study::AxisResult& axis, Clock clock);

/// Shares of the samples between validation points, by deciding rule.
std::string shares_figure(const study::AxisResult& axis, Clock clock);

/// Outliers, forgotten and released samples between validation points.
std::string departures_figure(const study::AxisResult& axis, Clock clock);

/// The seven largest effects of physics terms (study/terms.hpp) with standard errors, in the unit
/// of the target; then each coefficient in its own unit.
std::string effects_figure(const study::AxisResult& axis, Clock clock);
std::vector<std::string> coefficient_figures(const study::AxisResult& axis, Clock clock);

/// Histogram of the update times, logarithmic, median and p99 marked.
std::string timing_figure(const study::AxisResult& axis);

}  // namespace kelpie::report
