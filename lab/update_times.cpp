// SPDX-License-Identifier: Apache-2.0
#include "lab/update_times.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <limits>
#include <string>

#include "chart/text_table.hpp"
#include "chart/wording.hpp"
#include "kelpie/core/random.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/svr/resources.hpp"
#include "model/model_axis.hpp"
#include "study/summary.hpp"

namespace kelpie::lab {
namespace {

constexpr double kGrowth = 2.6;  // above the ratio at which scales are taken anew

double square(double value) {
  return value * std::abs(value);
}

// A made-up vehicle with three axes, three commands and noise. At regular times, by turns, either
// the vehicle becomes another of three vehicles, or one input grows beyond the ratio for new
// scales.
class EventfulDrive {
 public:
  static constexpr std::size_t kInputs = 6;
  static constexpr std::size_t kAxes = 3;

  // `events` changes of each kind within the samples. The same for the same seed.
  EventfulDrive(std::size_t samples, std::size_t events, std::uint64_t seed)
      : random_(seed, "eventful drive"),
        every_(std::max<std::size_t>(1, samples / (2 * events + 1))),
        most_events_(2 * events) {
    for (double& phase : phase_) {
      phase = random_.uniform(0.0, 6.0);
    }
    size_.fill(1.4);
  }

  void next() {
    if (sample_ > 0 && sample_ % every_ == 0 && sample_ / every_ <= most_events_) {
      happen(sample_ / every_);
    }
    ++sample_;
    for (std::size_t k = 0; k < kInputs; ++k) {
      phase_[k] += random_.uniform(0.02, 0.2);
      x_[k] = size_[k] * std::sin(phase_[k]);
    }
    const auto& [u, v, r, surge, sway, yaw] = x_;
    const double thrust = vehicle_ == 1 ? 0.5 : 1.0;
    const double side = vehicle_ == 2 ? -1.0 : 1.0;
    y_ = {thrust * surge - 0.5 * square(u) - 0.3 * u + 0.4 * v * r,
          side * sway - 0.8 * square(v) - 0.4 * u * r + 0.2 * std::sin(v),
          thrust * yaw - 0.4 * square(r) + side * 0.3 * square(surge) - 0.2 * r};
    for (double& acceleration : y_) {
      acceleration += (0.05 + 0.015 * std::abs(acceleration)) * random_.normal();
    }
  }

  const std::array<double, kInputs>& x() const { return x_; }
  const std::array<double, kAxes>& y() const { return y_; }  // accelerations

 private:
  void happen(std::size_t event) {
    if (event % 2 == 1) {
      vehicle_ = (vehicle_ + 1) % 3;
    } else {
      size_[(event / 2) % kInputs] *= kGrowth;
    }
  }

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

constexpr std::array kEdgesUs{100.0, 200.0, 500.0, 1e3, 1.5e3, 2e3, 3e3, 5e3, 7.5e3, 1e4, 2e4, 5e4};

bool passed(void* deadline_us) {
  return thread_time_us() > *static_cast<const double*>(deadline_us);
}

std::string share_text(double share) {
  return share > 0.0 ? fmt::format("{:.4g} %", 100.0 * share) : "";
}

chart::TextTable histogram_table(const UpdateTimes& times) {
  chart::TextTable table{"Single updates of a model with three axes",
                         {"time", "thread", "share", "wall", "share"},
                         {}};
  const std::vector<TimesBin> bins = histogram_of(times);
  const auto all = static_cast<double>(times.thread_us.size());
  for (std::size_t k = 0; k < bins.size(); ++k) {
    const bool last = k + 1 == bins.size();
    const std::string edge = chart::duration(last ? bins[k - 1].below_us : bins[k].below_us);
    table.rows.push_back({(last ? "from " : "below ") + edge, chart::grouped(bins[k].thread),
                          share_text(static_cast<double>(bins[k].thread) / all),
                          chart::grouped(bins[k].wall),
                          share_text(static_cast<double>(bins[k].wall) / all)});
  }
  return table;
}

chart::TextTable slowest_table(const UpdateTimes& times) {
  chart::TextTable table{"The slowest of them", {"", "median", "p99", "p99.9", "max"}, {}};
  const auto row = [&](const std::string& name, const std::vector<double>& all) {
    const study::Quantiles spread = study::quantiles_of(all);
    table.rows.push_back({name, chart::duration(spread.median), chart::duration(spread.p99),
                          chart::duration(spread.p999), chart::duration(spread.max)});
  };
  row("thread", times.thread_us);
  row("wall", times.wall_us);
  if (times.budget_us > 0.0) {
    table.rows.push_back({"wanted", "", "", "", "≤ " + chart::duration(1.5 * times.budget_us)});
  } else {
    table.rows.push_back({"wanted", "", "", "≤ 3 ms", "≤ 5 ms"});
  }
  return table;
}

std::string times_method(const UpdateTimes& times) {
  return fmt::format(
      "A model of three axes, default preset{}, drives for {} updates; found were {} changes of "
      "the vehicle on one of the axes, {} of them returns, and {} new scales. Times are of single "
      "updates, all axes together: the thread's own (CLOCK_THREAD_CPUTIME_ID) and that on the "
      "wall, "
      "which holds what else the machine did.",
      times.budget_us > 0.0 ? fmt::format(", a budget of {}", chart::duration(times.budget_us))
                            : "",
      chart::grouped(times.thread_us.size()), times.changes, times.recalls, times.rescales);
}

}  // namespace

double thread_time_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

UpdateTimes measure_update_times(const TimesPlan& plan) {
  const ModelSettings settings = ModelSettings::from_preset("default", EventfulDrive::kAxes);
  DynamicsModel model({"u", "v", "r", "th1", "th2", "th3"}, {"udot", "vdot", "rdot"}, settings);
  double deadline_us = 0.0;
  if (plan.budget_us > 0.0) {
    model.limit(Budget(std::numeric_limits<int>::max(), passed, &deadline_us));
  }
  EventfulDrive drive(plan.updates, plan.events, plan.seed);
  UpdateTimes times;
  times.budget_us = plan.budget_us;
  times.thread_us.reserve(plan.updates);
  times.wall_us.reserve(plan.updates);
  std::array<const AxisScaling*, EventfulDrive::kAxes> before{};
  std::array<double, EventfulDrive::kAxes> scale{};
  while (times.thread_us.size() < plan.updates && plan.keep_going(times.thread_us.size())) {
    drive.next();
    const double t = 0.1 * static_cast<double>(times.thread_us.size());
    const double start_us = thread_time_us();
    deadline_us = start_us + plan.budget_us;
    times.wall_us.push_back(timed_us([&] { model.update(drive.x(), drive.y(), t); }));
    times.thread_us.push_back(thread_time_us() - start_us);
    for (std::size_t i = 0; i < EventfulDrive::kAxes; ++i) {
      const AxisScaling* const scaling = model.mechanisms(i).scaling();
      const double now = scaling != nullptr ? scaling->target.scale : 0.0;
      times.rescales += before[i] != nullptr && now != scale[i] ? 1 : 0;
      before[i] = scaling;
      scale[i] = now;
    }
  }
  for (std::size_t i = 0; i < EventfulDrive::kAxes; ++i) {
    const Tally tally = model.axis(i).status().tally;
    times.changes += tally.changes;
    times.recalls += tally.recalls;
  }
  return times;
}

std::vector<TimesBin> histogram_of(const UpdateTimes& times) {
  std::vector<TimesBin> bins;
  for (const double edge : kEdgesUs) {
    bins.push_back({.below_us = edge});
  }
  bins.push_back({.below_us = std::numeric_limits<double>::infinity()});
  const auto count = [&](const std::vector<double>& all, std::size_t TimesBin::*member) {
    for (const double time : all) {
      ++((*std::ranges::upper_bound(bins, time, {}, &TimesBin::below_us)).*member);
    }
  };
  count(times.thread_us, &TimesBin::thread);
  count(times.wall_us, &TimesBin::wall);
  return bins;
}

std::string times_table(const UpdateTimes& times) {
  return chart::wrapped(times_method(times)) + "\n\n" + chart::table_text(histogram_table(times)) +
         chart::table_text(slowest_table(times));
}

}  // namespace kelpie::lab
