// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace kelpie::log {

/// One quantity as it was sent: values with stamps of their own.
struct Signal {
  std::string name;             ///< short one, as in "u"
  std::string from;             ///< "/odom:twist.twist.linear.x", or a column; for messages
  std::string topic;            ///< signals of one topic come together and share their delay
  std::vector<double> times_s;  ///< never decreasing once tidy
  std::vector<double> values;   ///< as many
  std::size_t steps_back = 0;   ///< samples stored behind one with a later stamp
  double longest_back_s = 0.0;  ///< how far back the farthest of these steps went
};

/// What was found wrong with a signal.
struct SignalFaults {
  std::size_t samples = 0;        ///< that are left
  std::size_t no_value = 0;       ///< NaN or infinite: left out
  std::size_t duplicates = 0;     ///< with the stamp of the one before: left out
  std::size_t steps_back = 0;     ///< put into the order of time
  std::size_t gaps = 0;           ///< silences longer than the gap given
  double longest_gap_s = 0.0;     ///< the longest silence, whether or not it counts as gap
  double longest_gap_at_s = 0.0;  ///< its beginning
  std::size_t stuck = 0;          ///< stretches of one value all along, longer than the gap
  double longest_stuck_s = 0.0;
  double longest_stuck_at_s = 0.0;
};

/// Puts a signal into the order of time, counting the steps back.
void sort_by_time(Signal& signal);

/// Leaves out what has no value or no stamp of its own, and counts what is wrong. What is stuck is
/// counted and stays: a vehicle at rest looks the same. Requires: sorted.
/// Throws InputError (from) when no sample is left, a step back was longer than `gap_s`, which
/// sorting would mix up, or a step ahead longer than 30 days: these are clocks set anew.
SignalFaults tidy(Signal& signal, double gap_s);

/// How a signal is taken between its samples.
enum class Between {
  line,  ///< on the straight line: measured states
  hold,  ///< the last value: commands
};

/// The values at some times (in any order). NaN before the first sample, after the last, and
/// where no sample is near enough: nothing bridges a silence longer than `gap_s`. (A held value
/// lasts up to `gap_s` beyond its sample.) Requires: tidy. Cost: O(log n) per time.
std::vector<double> resampled(const Signal& signal, std::span<const double> at_s, Between between,
                              double gap_s);

}  // namespace kelpie::log
