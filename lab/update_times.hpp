// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "chart/text_table.hpp"
#include "kelpie/core/random.hpp"

namespace kelpie::lab {

/// A made-up vehicle with three axes, three commands and some noise, to which things happen at
/// regular times, in turns: it becomes another one of three, or one of its six inputs grows so far
/// that scales are taken anew.
class EventfulDrive {
 public:
  static constexpr std::size_t kInputs = 6;
  static constexpr std::size_t kAxes = 3;

  /// `events` times both, within so many samples. The same for the same seed.
  EventfulDrive(std::size_t samples, std::size_t events, std::uint64_t seed);

  void next();  ///< There is always one more.

  const std::array<double, kInputs>& x() const { return x_; }  ///< of the sample at hand
  const std::array<double, kAxes>& y() const { return y_; }    ///< accelerations

 private:
  void happen(std::size_t event);

  RandomStream random_;
  std::size_t every_;
  std::size_t most_events_;
  std::size_t sample_ = 0;
  int vehicle_ = 0;
  std::array<double, kInputs> phase_{};
  std::array<double, kInputs> size_{};
  std::array<double, kInputs> x_{};
  std::array<double, kAxes> y_{};
};

/// Processor time of the calling thread.
double thread_time_us();

/// Memory of this process that is in use, as Linux tells it; 0 where it can't be read.
std::size_t resident_bytes();

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

chart::TextTable histogram_table(const UpdateTimes& times);  ///< The histogram.
chart::TextTable slowest_table(const UpdateTimes& times);    ///< Quantiles, and the targets.

/// The method of measurement, in a few sentences.
std::string times_method(const UpdateTimes& times);

}  // namespace kelpie::lab
