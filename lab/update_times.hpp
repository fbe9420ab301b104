// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "chart/text_table.hpp"

namespace kelpie::lab {

/// A model in a long life, every update of which is timed.
struct TimesPlan {
  std::size_t updates = 30'000;
  std::size_t events = 20;  ///< changes of the vehicle, and as many of its scale
  double budget_us = 0.0;   ///< of an update: DynamicsModel::limit; 0: none
  std::uint64_t seed = 1;
  /// Called now and then with the updates done so far; false stops the work.
  std::function<bool(std::size_t)> keep_going = [](std::size_t) { return true; };
};

/// Times of single updates of all axes together. On a machine that does other things too, the
/// thread's own time says what the update took, the time on the wall what a caller waited.
struct UpdateTimes {
  double budget_us = 0.0;
  std::vector<double> thread_us;
  std::vector<double> wall_us;
  std::int64_t changes = 0;  ///< found, of all axes together
  std::int64_t recalls = 0;  ///< those of them in which a past model was taken up
  std::int64_t rescales = 0;
};

/// Drives a DynamicsModel of three axes, default preset, over an EventfulDrive. The same plan
/// gives the same model, but with a budget.
UpdateTimes measure_update_times(const TimesPlan& plan);

/// A bin of a histogram: how many updates took less than `below_us`, but not less than the bin
/// before.
struct TimesBin {
  double below_us = 0.0;  ///< infinite in the last one
  std::size_t thread = 0;
  std::size_t wall = 0;
};
std::vector<TimesBin> histogram_of(const UpdateTimes& times);

chart::TextTable histogram_table(const UpdateTimes& times);  ///< The histogram.
chart::TextTable slowest_table(const UpdateTimes& times);    ///< Quantiles, and what is wanted.

/// What was measured how, in a sentence or two.
std::string times_method(const UpdateTimes& times);

}  // namespace kelpie::lab
