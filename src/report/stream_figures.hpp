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

// Figures of one stream, as HTML. All over time are linked: one window, one cursor.

/// The whole run of an axis: each sample as it was and as it was predicted just before it was
/// learned, with the interval then in force; changes and outliers.
std::string course_figure(const study::AxisResult& axis, Clock clock);

/// One line of r2_figure().
struct R2Line {
  std::string name;
  const study::AxisResult* axis = nullptr;
};

/// Validation R² over time, in the order of the lines. The figure ends at −0.2: how many points lie
/// below is in the caption. Changes of the vehicle are marked, those in the log and those found.
std::string r2_figure(const std::vector<R2Line>& lines, Clock clock);
std::string r2_figure(const study::StreamResult& result, Clock clock);  ///< Of all axes.

/// All held-out rows, true and predicted by the model at the end of the stream, over time.
std::string held_out_figure(const study::AxisResult& axis, Clock clock);

/// Predicted against true, all held-out rows (thinned).
std::string scatter_figure(const study::AxisResult& axis);

/// Share of samples inside their interval, over windows of kCoverageWindow samples, of all axes.
std::string coverage_figure(const study::StreamResult& result, Clock clock);

/// Error on held-out rows by the novelty of their place.
std::string novelty_figure(const study::AxisResult& axis);

/// Buffer and support vectors over time.
std::string buffer_figure(const study::AxisResult& axis, Clock clock);

/// Shares of the samples between validation points that each rule decided.
std::string shares_figure(const study::AxisResult& axis, Clock clock);

/// Outliers, forgotten and released samples between validation points.
std::string departures_figure(const study::AxisResult& axis, Clock clock);

/// Effects of the physics terms (study/terms.hpp) with standard errors: the seven largest, in the
/// target's unit; then the coefficient of each in its own unit.
std::string effects_figure(const study::AxisResult& axis, Clock clock);
std::vector<std::string> coefficient_figures(const study::AxisResult& axis, Clock clock);

/// Histogram of the update times, logarithmic, median and p99 marked.
std::string timing_figure(const study::AxisResult& axis);

}  // namespace kelpie::report
