// SPDX-License-Identifier: Apache-2.0
// A stream, shown messages as they arrive, gives what a log of these messages gives, to the bit.
#include "log/streamed_signals.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "kelpie/core/random.hpp"
#include "log/sampling.hpp"
#include "log/signals.hpp"

namespace kelpie::streamed_signals_test {
namespace {

using testing::signal_of;
using testing::Vehicle;

struct Message {
  std::size_t source;
  double stamp_s;
  double value;
  double arrives_s;
};

// Rows as one list of numbers: t, then every column.
using Rows = std::vector<std::vector<double>>;

bool same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) ||
         (std::isnan(a) && std::isnan(b));
}

log::SamplingPlan plan_of(FilterWindow window) {
  log::SamplingPlan plan;
  plan.sources = {
      {.name = "u", .from = "/u:x"},
      {.name = "v", .from = "/v:x"},
      {.name = "w", .from = "/w:x"},
      {.name = "p", .from = "/p:x", .lag_s = 0.04},
      {.name = "q", .from = "/q:x"},
      {.name = "r", .from = "/r:x"},
      {.name = "port", .from = "/port:x", .between = Interpolation::hold, .lag_s = 0.3},
      {.name = "side", .from = "/side:x", .between = Interpolation::hold, .lag_s = -0.15}};
  plan.derived = {{"udot", "u"}, {"vdot", "v"}, {"portdot", "port"}};
  plan.vectors = {{{"u", "v", "w"}, Frame::frd, Frame::flu},
                  {{"u", "v", "w"}, Frame::enu, Frame::ned}};
  plan.lever_arm = {{"u", "v", "w"}, {"p", "q", "r"}, {0.4, -0.2, 0.1}};
  plan.derivative = {.window = window, .window_s = 0.5, .degree = 2};
  plan.rate_hz = 10.0;
  return plan;
}

// The vehicle's signals at rates of their own, with jitter of stamps and silences.
std::vector<log::Signal> signals_of(RandomStream& random) {
  static const Vehicle vehicle(61.0);
  const auto u = [](double t) { return vehicle.u(t); };
  const auto v = [](double t) { return vehicle.v(t); };
  const auto rate = [](double t) { return 0.3 * std::sin(t); };
  std::vector<log::Signal> signals{signal_of("u", u, 20.0, 1.03, 60.0),
                                   signal_of("v", v, 20.0, 1.03, 60.0),
                                   signal_of("w", u, 20.0, 1.03, 60.0),
                                   signal_of("p", rate, 33.0, 0.5, 60.0),
                                   signal_of("q", rate, 33.0, 0.5, 60.0),
                                   signal_of("r", rate, 10.0, 0.0, 60.0),
                                   signal_of("port", Vehicle::port, 7.0, 2.0, 57.0),
                                   signal_of("side", Vehicle::side, 25.0, 0.0, 60.0)};
  std::vector<double> jitter_s(1300);
  std::ranges::generate(jitter_s, [&] { return random.uniform(0.0, 0.03); });
  for (std::size_t k = 0; k < signals.size(); ++k) {
    log::Signal& signal = signals[k];
    // Components of the velocity share their messages.
    const double silence_s = 10.0 + 5.0 * static_cast<double>(k < 3 ? 0 : k);
    log::Signal kept = signal;
    kept.times_s.clear();
    kept.values.clear();
    for (std::size_t i = 0; i < signal.times_s.size(); ++i) {
      const double t = signal.times_s[i] + (k < 3 ? jitter_s[i] : random.uniform(0.0, 0.03));
      const bool is_silent = (t > silence_s && t < silence_s + 2.5) || (t > 50.0 && t < 53.5);
      if (!is_silent) {
        kept.times_s.push_back(t);
        kept.values.push_back(i % 97 == 5 ? std::nan("") : signal.values[i]);
      }
    }
    signal = kept;
  }
  return signals;
}

// In the order of their arrival, each up to `most_s` late, commands up to `commands_s`. Those of
// one topic stay in order.
std::vector<Message> messages_of(const std::vector<log::Signal>& signals, RandomStream& random,
                                 double most_s, double commands_s) {
  std::vector<Message> messages;
  for (std::size_t k = 0; k < signals.size(); ++k) {
    double before = 0.0;
    for (std::size_t i = 0; i < signals[k].times_s.size(); ++i) {
      const double stamp = signals[k].times_s[i];
      before = std::max(before, stamp + random.uniform(0.0, k < 6 ? most_s : commands_s));
      messages.push_back({k, stamp, signals[k].values[i], before});
    }
  }
  std::ranges::stable_sort(messages, {}, &Message::arrives_s);
  return messages;
}

Rows rows_of_log(const log::SamplingPlan& plan, const std::vector<log::Signal>& signals) {
  const log::Table table = log::sample(plan, signals, "log").table;
  Rows rows(table.rows());
  for (std::size_t row = 0; row < rows.size(); ++row) {
    for (const std::vector<double>& column : table.columns) {
      rows[row].push_back(column[row]);
    }
  }
  return rows;
}

// `used`: what was used of each message, for those who want to know.
Rows rows_of_stream(const log::SamplingPlan& plan, const std::vector<Message>& messages,
                    std::vector<bool>* used = nullptr) {
  StreamPlan whole = plan;
  for (const StreamPlan::Source& source : plan.sources) {
    whole.inputs.push_back(source.name);
  }
  for (const StreamPlan::Derived& derived : plan.derived) {
    whole.targets.push_back(derived.name);
  }
  SampleStream stream(whole);
  Rows rows;
  const auto take = [&] {
    while (const auto* const row = stream.next()) {
      rows.push_back({row->t});
      rows.back().insert(rows.back().end(), row->x.begin(), row->x.end());
      rows.back().insert(rows.back().end(), row->y.begin(), row->y.end());
    }
  };
  for (const Message& message : messages) {
    const SignalVerdict heard = stream.feed(message.source, message.stamp_s, message.value);
    if (used != nullptr) {
      used->push_back(heard == SignalVerdict::used);
    }
    take();
  }
  stream.finish();
  take();
  return rows;
}

// All rows of the log, and after them only some that a log ends before.
void expect_same(const Rows& log, const Rows& stream, double gap_s) {
  ASSERT_GE(stream.size(), log.size());
  for (std::size_t row = 0; row < log.size(); ++row) {
    ASSERT_EQ(log[row].size(), stream[row].size());
    for (std::size_t i = 0; i < log[row].size(); ++i) {
      ASSERT_TRUE(same(log[row][i], stream[row][i]))
          << "row " << row << " at " << log[row][0] << " s, column " << i << ": " << log[row][i]
          << " in the log, " << stream[row][i] << " in the stream";
    }
  }
  EXPECT_LT(stream.back()[0], 60.0 + gap_s + 0.5);
}

TEST(StreamedSignals, MessagesThatArriveInAnyOrderOfTopicsGiveTheRowsOfTheLog) {
  for (const FilterWindow window : {FilterWindow::centred, FilterWindow::causal}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      RandomStream random(seed, "stream");
      const log::SamplingPlan plan = plan_of(window);
      const std::vector<log::Signal> signals = signals_of(random);
      const Rows log = rows_of_log(plan, signals);
      const Rows stream =
          rows_of_stream(plan, messages_of(signals, random, plan.wait_s, plan.wait_s));
      ASSERT_NO_FATAL_FAILURE(expect_same(log, stream, plan.gap_s)) << "seed " << seed;
      const auto whole = std::ranges::count_if(log, [](const auto& row) {
        return std::ranges::all_of(row, [](double value) { return std::isfinite(value); });
      });
      EXPECT_GT(whole, 200) << "little was compared";
      EXPECT_LT(static_cast<std::size_t>(whole), log.size()) << "no silence was compared";
    }
  }
}

TEST(StreamedSignals, WhatArrivesTooLateIsLeftOutAndTheRestIsAsInALogWithoutIt) {
  log::SamplingPlan plan = plan_of(FilterWindow::causal);
  plan.lever_arm.reset();
  plan.vectors.clear();
  plan.wait_s = 0.05;
  RandomStream random(7, "stream");
  std::vector<log::Signal> signals = signals_of(random);
  const std::vector<Message> messages = messages_of(signals, random, 0.0, 0.9);
  std::vector<bool> used;
  Rows stream = rows_of_stream(plan, messages, &used);
  std::size_t left_out = 0;
  for (log::Signal& signal : signals) {
    signal.times_s.clear();
    signal.values.clear();
  }
  for (std::size_t i = 0; i < messages.size(); ++i) {
    if (used[i]) {
      signals[messages[i].source].times_s.push_back(messages[i].stamp_s);
      signals[messages[i].source].values.push_back(messages[i].value);
    } else {
      left_out += std::isnan(messages[i].value) ? 0 : 1;
    }
  }
  EXPECT_GT(left_out, 50U);
  // Whether a row in a silence is there without a value, or isn't there, is all the same.
  Rows log = rows_of_log(plan, signals);
  for (Rows* const rows : {&log, &stream}) {
    std::erase_if(*rows, [](const auto& row) {
      return std::all_of(row.begin() + 1, row.end(), [](double v) { return std::isnan(v); });
    });
  }
  expect_same(log, stream, plan.gap_s);
}

}  // namespace
}  // namespace kelpie::streamed_signals_test
