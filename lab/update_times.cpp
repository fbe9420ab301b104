// SPDX-License-Identifier: Apache-2.0
#include "lab/update_times.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include "chart/wording.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "lab/bench_parts.hpp"
#include "lab/eventful_drive.hpp"
#include "lab/process_costs.hpp"
#include "model/dynamics_axis.hpp"
#include "study/summary.hpp"
#include "svr/budget.hpp"

namespace kelpie::lab {
namespace {

constexpr std::array kEdgesUs{100.0, 200.0, 500.0, 1e3, 1.5e3, 2e3, 3e3, 5e3, 7.5e3, 1e4, 2e4, 5e4};

bool passed(void* deadline_us) {
  return thread_time_us() > *static_cast<const double*>(deadline_us);
}

std::string count_text(std::size_t count) {
  return chart::grouped(static_cast<std::int64_t>(count));
}

std::string share_text(double share) {
  return share > 0.0 ? fmt::format("{:.4g} %", 100.0 * share) : "";
}

}  // namespace

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

chart::TextTable histogram_table(const UpdateTimes& times) {
  chart::TextTable table{"Single updates of a model with three axes",
                         {"time", "thread", "share", "wall", "share"},
                         {}};
  const std::vector<TimesBin> bins = histogram_of(times);
  const auto all = static_cast<double>(times.thread_us.size());
  for (std::size_t k = 0; k < bins.size(); ++k) {
    const bool last = k + 1 == bins.size();
    const std::string edge = chart::duration(last ? bins[k - 1].below_us : bins[k].below_us);
    table.rows.push_back({(last ? "from " : "below ") + edge, count_text(bins[k].thread),
                          share_text(static_cast<double>(bins[k].thread) / all),
                          count_text(bins[k].wall),
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
      count_text(times.thread_us.size()), times.changes, times.recalls, times.rescales);
}

}  // namespace kelpie::lab
