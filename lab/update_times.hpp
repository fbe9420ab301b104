// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace kelpie::lab {

double thread_time_us();  ///< Processor time of the calling thread.

/// Wall time of a call.
template <typename Work>
double timed_us(Work work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start)
      .count();
}

/// A long drive with each update of the model timed.
struct TimesPlan {
  std::size_t updates = 30'000;
  std::size_t events = 20;  ///< changes of the vehicle, and as many of its scale
  double budget_us = 0.0;   ///< of an update: DynamicsModel::limit; 0: none
  std::uint64_t seed = 1;
  /// Called now and then with the updates done so far; false stops the work.
  std::function<bool(std::size_t)> keep_going = [](std::size_t) { return true; };
};

/// Times of single updates, axes together. On a busy machine the thread time is the cost of the
/// update, and the wall time is the delay of the caller.
struct UpdateTimes {
  double budget_us = 0.0;
  std::vector<double> thread_us;
  std::vector<double> wall_us;
  std::int64_t changes = 0;  ///< detected, axes together
  std::int64_t recalls = 0;  ///< changes with a recalled past model
  std::int64_t rescales = 0;
};

/// Drives a DynamicsModel of three axes, default preset, over an EventfulDrive. The same plan
/// gives the same model, except with a budget.
UpdateTimes measure_update_times(const TimesPlan& plan);

/// A bin of a histogram: the number of updates below `below_us` and above the bin before.
struct TimesBin {
  double below_us = 0.0;  ///< infinite in the last one
  std::size_t thread = 0;
  std::size_t wall = 0;
};
std::vector<TimesBin> histogram_of(const UpdateTimes& times);

/// Method, histogram, quantiles and targets, for a terminal.
std::string times_table(const UpdateTimes& times);

}  // namespace kelpie::lab
