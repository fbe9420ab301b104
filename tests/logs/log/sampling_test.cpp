// SPDX-License-Identifier: Apache-2.0
#include "log/sampling.hpp"

#include <gtest/gtest.h>

#include "kelpie/core/error.hpp"
#include "log/signals.hpp"
#include "support.hpp"

namespace kelpie::sampling_test {
namespace {

using testing::signal_of;
using testing::Vehicle;

double ramp(double t) {
  return 1.0 + 2.0 * t;
}

log::SamplingPlan plan_of(const std::vector<std::string>& states) {
  log::SamplingPlan plan;
  for (const std::string& name : states) {
    plan.sources.push_back({.name = name, .from = "/" + name + ":x"});
  }
  plan.rate_hz = 10.0;
  return plan;
}

std::string refusal(const log::SamplingPlan& plan, const std::vector<log::Signal>& signals) {
  return testing::message_of<InputError>([&] { log::sample(plan, signals, "bag"); });
}

const std::vector<double>& column(const log::Samples& samples, const std::string& name) {
  return samples.table.columns[samples.table.find(name)];
}

TEST(Sampling, TopicsOfDifferentRatesMeetOnOneGrid) {
  log::SamplingPlan plan = plan_of({"u", "n"});
  plan.sources[1].between = Interpolation::hold;
  plan.derived = {{"udot", "u"}};
  const log::Samples samples = log::sample(
      plan, {signal_of("u", ramp, 20.0, 0.03, 20.0), signal_of("n", ramp, 7.0, 1.01, 15.0)}, "bag");
  const std::vector<double>& t = column(samples, "t");
  EXPECT_NEAR(t.front(), 1.1, 1e-9);
  EXPECT_NEAR(t.back(), 14.8, 1e-9);
  for (std::size_t row = 0; row < t.size(); ++row) {
    EXPECT_NEAR(column(samples, "u")[row], ramp(t[row]), 1e-9);
    EXPECT_NEAR(column(samples, "udot")[row], 2.0, 1e-9);
    const double late = (ramp(t[row]) - column(samples, "n")[row]) / 2.0;
    EXPECT_TRUE(late > -1e-9 && late < 1.0 / 7.0 + 1e-9) << late;
  }
  EXPECT_EQ(samples.report.whole_rows, t.size());
  EXPECT_EQ(samples.report.segments, 1U);
}

TEST(Sampling, ALagGivenIsTakenOut) {
  log::SamplingPlan plan = plan_of({"u"});
  plan.sources[0].lag_s = 0.25;
  const log::Samples samples =
      log::sample(plan, {signal_of("u", ramp, 20.0, 0.0, 10.0, 0.25)}, "bag");
  EXPECT_NEAR(column(samples, "u")[30], ramp(column(samples, "t")[30]), 1e-9);
}

TEST(Sampling, AnEstimatedLagGoesByTheFirstPartOnly) {
  const Vehicle vehicle(121.0);
  const auto signals = [&](double late_afterwards) {
    log::Signal port = signal_of("port", Vehicle::port, 25.0, 0.0, 120.0, 0.3);
    for (double& t : port.times_s) {
      t += t > 62.0 ? late_afterwards : 0.0;
    }
    return std::vector<log::Signal>{
        signal_of(
            "u", [&](double t) { return vehicle.u(t); }, 20.0, 0.0, 120.0),
        port};
  };
  log::SamplingPlan plan = plan_of({"u", "port"});
  plan.sources[1].lag_s = std::nullopt;
  plan.derived = {{"udot", "u"}};
  plan.responses = {"udot"};
  const log::Samples samples = log::sample(plan, signals(0.0), "bag");
  EXPECT_NEAR(samples.report.sources[1].lag_s, 0.3, 0.03);
  EXPECT_LE(samples.report.lag_until_s, 60.5);
  const std::vector<double>& t = column(samples, "t");
  EXPECT_NEAR(column(samples, "port")[200], Vehicle::port(t[200]), 0.1);
  // What comes later has no say.
  EXPECT_EQ(log::sample(plan, signals(0.5), "bag").report.sources[1].lag_s,
            samples.report.sources[1].lag_s);
  ASSERT_TRUE(samples.report.lags.has_value());
  EXPECT_GT(samples.report.lags->explained, samples.report.lags->explained_at_zero);
}

// Memory goes by the samples, not by the time between them.
TEST(Sampling, ASilenceOfAllSignalsHasNoRows) {
  log::Signal u = signal_of("u", ramp, 20.0, 0.0, 20.0);
  const std::size_t before = u.times_s.size();
  for (std::size_t k = 0; k < before; ++k) {
    u.times_s.push_back(u.times_s[k] + 1e6);
    u.values.push_back(u.values[k]);
  }
  const log::Samples samples = log::sample(plan_of({"u"}), {u}, "bag");
  EXPECT_EQ(samples.report.whole_rows, 2U * 201U);
  EXPECT_LE(samples.table.rows(), 2U * 211U);
  EXPECT_EQ(samples.report.segments, 2U);
  EXPECT_NEAR(column(samples, "t").back(), 1e6 + 20.0, 1e-6);
}

TEST(Sampling, SamplesThatAreAllTooFarApartAreRefused) {
  const log::Signal in_ms = signal_of("u", ramp, 1.0 / 250.0, 0.0, 1e5);
  EXPECT_NE(refusal(plan_of({"u"}), {in_ms})
                .find("/u:x: its samples come every 250 s, and silences longer than 1 s aren't"),
            std::string::npos);
  log::SamplingPlan held = plan_of({"u"});
  held.sources[0].between = Interpolation::hold;
  EXPECT_EQ(refusal(held, {in_ms}), "");
}

TEST(Sampling, ARateThatMakesFarMoreRowsThanSamplesIsRefused) {
  log::SamplingPlan plan = plan_of({"u"});
  plan.rate_hz = 1e6;
  EXPECT_EQ(refusal(plan, {signal_of("u", ramp, 20.0, 0.0, 20.0)}),
            "bag: rate: 1e+06 rows per second are more than 1000 per sample of the log");
}

TEST(Sampling, ASilenceSplitsTheRows) {
  log::Signal u = signal_of("u", ramp, 20.0, 0.0, 20.0);
  u.times_s.erase(u.times_s.begin() + 200, u.times_s.begin() + 260);  // 10 to 13 s
  u.values.erase(u.values.begin() + 200, u.values.begin() + 260);
  log::SamplingPlan plan = plan_of({"u"});
  plan.derived = {{"udot", "u"}};
  const log::Samples samples = log::sample(plan, {u}, "bag");
  EXPECT_EQ(samples.report.segments, 2U);
  EXPECT_EQ(samples.report.sources[0].faults.gaps, 1U);
  std::size_t known = 0;
  for (std::size_t row = 0; row < samples.table.rows(); ++row) {
    const double t = column(samples, "t")[row];
    const double value = column(samples, "u")[row];
    EXPECT_TRUE((t < 9.96 || t > 12.99) || std::isnan(value)) << t;
    EXPECT_TRUE((t < 9.96 || t > 12.99) || std::isnan(column(samples, "udot")[row])) << t;
    known += std::isnan(value) ? 0 : 1;
  }
  EXPECT_GT(known, 0.8 * 17.0 * plan.rate_hz);  // of the other 17 seconds
}

TEST(Sampling, VectorsAreConvertedAndTheArmTakenOut) {
  log::SamplingPlan plan = plan_of({"u", "v", "w", "p", "q", "r"});
  plan.vectors = {{{"u", "v", "w"}, Frame::frd, Frame::flu}};
  plan.lever_arm = {{"u", "v", "w"}, {"p", "q", "r"}, {2.0, 0.0, 0.0}};
  std::vector<log::Signal> signals;
  const std::vector<double> constants{1.0, -0.5, -0.25, 0.0, 0.0, 0.1};
  for (std::size_t k = 0; k < constants.size(); ++k) {
    const double value = constants[k];
    signals.push_back(signal_of(
        plan.sources[k].name, [=](double) { return value; }, k < 3 ? 10.0 : 37.0, 0.0, 5.0));
  }
  const log::Samples samples = log::sample(plan, signals, "bag");
  EXPECT_NEAR(column(samples, "u")[9], 1.0, 1e-12);
  EXPECT_NEAR(column(samples, "v")[9], 0.5 - 0.1 * 2.0, 1e-12);
  EXPECT_NEAR(column(samples, "w")[9], 0.25, 1e-12);
  plan.vectors = {{{"u", "v", "r"}, Frame::frd, Frame::flu}};
  EXPECT_NE(refusal(plan, signals).find("/r:x: doesn't come in the same messages as /u:x"),
            std::string::npos);
}

TEST(Sampling, WhatCannotBeIsRefusedByName) {
  const std::vector<log::Signal> apart{signal_of("u", ramp, 10.0, 0.0, 3.0),
                                       signal_of("n", ramp, 10.0, 7.0, 9.0)};
  EXPECT_TRUE(refusal(plan_of({"u", "n"}), apart)
                  .starts_with("bag: /u:x: ends at 3.000 s, before /n:x begins at 7.000 s"))
      << refusal(plan_of({"u", "n"}), apart);
  log::SamplingPlan plan = plan_of({"u", "n"});
  plan.rate_hz = -1.0;
  EXPECT_NE(refusal(plan, apart).find("rate: -1 is out of range"), std::string::npos);
  plan = plan_of({"u", "u"});
  EXPECT_NE(refusal(plan, apart).find("u: is the name of two columns"), std::string::npos);
  plan = plan_of({"u", "n"});
  plan.derived = {{"udot", "U"}};
  EXPECT_NE(refusal(plan, apart).find("udot: 'U' is no state or command (did you mean"),
            std::string::npos);
}

}  // namespace
}  // namespace kelpie::sampling_test
