// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace kelpie::log {

/// The longest silence within one log [s]; in a longer one a clock was set.
constexpr double kLongestSilenceS = 30.0 * 86400.0;

/// One quantity as it was sent: values with stamps of their own.
struct Signal {
  std::string name;             ///< short one, as in "u"
  std::string from;             ///< "/odom:twist.twist.linear.x", or a column; for messages
  std::string topic;            ///< signals of one topic come together and share their delay
  std::vector<double> times_s;  ///< as recorded, until sorted
  std::vector<double> values;   ///< as many; NaN: none
  std::size_t steps_back = 0;   ///< samples stored behind one with a later stamp
  double longest_back_s = 0.0;  ///< how far back the farthest of these steps went
};

/// Puts a signal into the order of time, counting the steps back.
void sort_by_time(Signal& signal);

/// The median step between stamps that have a finite value [s]; 0 for a single one.
/// Requires: sorted.
double median_step_s(const Signal& signal);

}  // namespace kelpie::log
