// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "log/tuning.hpp"

namespace kelpie::log {

/// A recorded quantity: values with time stamps.
struct Signal {
  std::string name;             ///< short name, as in "u"
  std::string from;             ///< "/odom:twist.twist.linear.x", or a column; for messages
  std::string topic;            ///< signals of a topic arrive together and share a delay
  std::vector<double> times_s;  ///< as recorded, until sorted
  std::vector<double> values;   ///< a value per stamp; NaN: missing
  std::size_t steps_back = 0;   ///< samples stored behind a sample with a later stamp
  double longest_back_s = 0.0;  ///< largest step back in time
};

/// Puts a signal into the order of time, counting the steps back.
void sort_by_time(Signal& signal);

/// The median step between stamps with finite values [s]; 0 for a single stamp. Requires: sorted.
double median_step_s(const Signal& signal);

}  // namespace kelpie::log
