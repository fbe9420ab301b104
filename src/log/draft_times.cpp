// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "log/draft_plan.hpp"

namespace kelpie::log {
namespace {

constexpr double kUsualRate = 10.0;  // rows per second
constexpr double kFastestRate = 50.0;
constexpr double kWantedRows = 1000.0;
constexpr double kLongestGap = 5.0;      // s: commands that are sent when they change
constexpr double kSlow = 5.0;            // Hz: thrusters answer within tenths of a second
constexpr double kFarthestStamps = 1.0;  // s that clocks of one log may be apart
constexpr double kWidestStamps = 10.0;   // s

void choose_rate(const bag::BagReport& report, const SignalRates& rates, DraftPlan& plan) {
  if (!plan.is_of_bag) {
    if (plan.time.empty()) {
      plan.open.emplace_back(
          "time: no column is named t, time, stamp or the like; accelerations "
          "take one");
    } else if (const double rate = report.topics.front().rate_hz; rate < 0.01 || rate > 1e5) {
      plan.open.push_back(
          fmt::format("time: the column {} gives {:.3g} rows per second, which is hardly in s",
                      plan.time, rate));
    }
  }
  if (plan.targets.empty()) {
    return;
  }
  if (!(rates.moving_hz > 0.0)) {
    plan.open.emplace_back("velocities: their times tell no rate");
    return;
  }
  const double wanted =
      std::clamp(kWantedRows / std::max(report.duration_s, 1.0), kUsualRate, kFastestRate);
  plan.rate_hz = std::min(wanted, rates.moving_hz);
  plan.rate_hz = plan.rate_hz > 1.0 ? std::floor(plan.rate_hz + 0.1) : plan.rate_hz;
  plan.rate_why = plan.rate_hz < wanted - 1.0 ? "velocities come no faster"
                  : wanted > kUsualRate + 1.0 ? "the log is short"
                                              : "enough for a vehicle";
  double slowest = rates.moving_hz;
  for (const CandidateColumn& column : rates.used) {
    slowest = std::min(slowest, column.rate_hz);
  }
  plan.gap_s = std::clamp(std::ceil(30.0 / slowest) / 10.0, 1.0, kLongestGap);
  plan.window_s = std::max(0.5, std::ceil(60.0 / rates.moving_hz) / 10.0);
}

void choose_clock(const SignalRates& rates, DraftPlan& plan) {
  double low = INFINITY;
  double high = -INFINITY;
  for (const CandidateColumn& column : rates.used) {
    if (!column.stamps || column.stamps->high_s - column.stamps->low_s > kWidestStamps) {
      return;
    }
    low = std::min(low, column.stamps->median_s);
    high = std::max(high, column.stamps->median_s);
  }
  if (high - low <= kFarthestStamps) {
    plan.clock = bag::Clock::header;
  }
}

void say_what_is_slow(const bag::BagReport& report, const SignalRates& rates, DraftPlan& plan) {
  if (rates.commands_hz < kSlow) {
    plan.remarks.push_back(fmt::format(
        "commands come at {:.2g} Hz; what the thrusters did in between isn't in the log, and a "
        "model of it stays poor: 10 Hz or more are wanted",
        rates.commands_hz));
  }
  if (rates.moving_hz < kSlow) {
    plan.remarks.push_back(fmt::format(
        "velocities come at {:.2g} Hz: accelerations are slopes over {:.2g} s, and what is "
        "faster can't be seen",
        rates.moving_hz, plan.window_s));
  }
  const double rows = plan.rate_hz * report.duration_s;
  if (!plan.targets.empty() && rows < 300.0) {
    plan.remarks.push_back(fmt::format(
        "{:.0f} rows are few: the last of them say little of how good a model is", rows));
  }
}

// Of a file of MATLAB: how fast its rows were taken nobody can tell.
void ask_for_row_times(const bag::BagReport& report, const SignalRates& rates, DraftPlan& plan) {
  for (const bag::TopicReport& topic : report.topics) {
    const bool is_used = std::ranges::any_of(
        rates.used, [&](const CandidateColumn& column) { return column.topic == topic.name; });
    if (is_used && topic.type == "matlab/RowsWithoutTime") {
      plan.open.push_back("time: the rows of " + topic.name +
                          " have none; name their time by time, or write how many there are per "
                          "second by rate");
    }
  }
}

}  // namespace

void plan_times(const bag::BagReport& report, const SignalRates& rates, DraftPlan& plan) {
  ask_for_row_times(report, rates, plan);
  choose_rate(report, rates, plan);
  choose_clock(rates, plan);
  say_what_is_slow(report, rates, plan);
}

}  // namespace kelpie::log
