// SPDX-License-Identifier: Apache-2.0
#include "kelpie/stream/sample_stream.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "allocation_count.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "support.hpp"

namespace kelpie::sample_stream_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Row {
  double t;
  std::vector<double> x;
  std::vector<double> y;
  bool is_whole;
};

std::vector<Row> rows_of(SampleStream& stream) {
  std::vector<Row> rows;
  while (const auto* const row = stream.next()) {
    rows.push_back(
        {row->t, {row->x.begin(), row->x.end()}, {row->y.begin(), row->y.end()}, row->is_whole});
  }
  return rows;
}

// A velocity, a command, and the velocity's derivative.
StreamPlan plan_of(FilterWindow window = FilterWindow::causal) {
  StreamPlan plan;
  plan.sources = {{.name = "u"}, {.name = "n", .between = Interpolation::hold}};
  plan.derived = {{"udot", "u"}};
  plan.inputs = {"u", "n"};
  plan.targets = {"udot"};
  plan.derivative = {.window = window, .window_s = 0.5, .degree = 2};
  plan.rate_hz = 10.0;
  plan.wait_s = 0.1;
  return plan;
}

// u = 2 t at 20 Hz and n at 10 Hz, between two times; how many rows were whole.
std::size_t drive(SampleStream& stream, double from_s, double to_s) {
  std::size_t whole = 0;
  const auto steps = std::lround((to_s - from_s) * 20.0);
  for (long k = 0; k < steps; ++k) {
    const double t = from_s + 0.05 * static_cast<double>(k);
    stream.feed(0, t, 2.0 * t);
    if (k % 2 == 0) {
      stream.feed(1, t, std::sin(t));
    }
    while (const auto* const row = stream.next()) {
      whole += row->is_whole ? 1 : 0;
    }
  }
  return whole;
}

TEST(SampleStream, ARowComesWithTheLastMessageItTakes) {
  SampleStream stream(plan_of());
  for (int k = 0; k <= 20; ++k) {
    stream.feed(0, 0.05 * k, 0.1 * k);
    stream.feed(1, 0.05 * k, 0.05 * k);
  }
  std::vector<Row> rows = rows_of(stream);
  ASSERT_EQ(rows.size(), 11U);  // 0 to 1 s
  EXPECT_FALSE(rows[0].is_whole);
  EXPECT_TRUE(rows[10].is_whole);
  EXPECT_NEAR(rows[10].y[0], 2.0, 1e-9);
  stream.feed(0, 1.07, 2.14);
  stream.feed(1, 1.07, 5.0);
  EXPECT_TRUE(rows_of(stream).empty());
  stream.feed(0, 1.14, 2.28);
  EXPECT_TRUE(rows_of(stream).empty());  // the command at 1.1 s may still be on its way
  stream.feed(0, 1.25, 2.5);
  rows = rows_of(stream);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_NEAR(rows[0].x[0], 2.2, 1e-9);
  EXPECT_EQ(rows[0].x[1], 5.0);
}

TEST(SampleStream, SamplesAreScaledAboutAPoint) {
  StreamPlan plan = plan_of();
  plan.sources[0].scale = 0.5;
  plan.sources[1].scale = -1.0;
  plan.sources[1].about = 1500.0;
  SampleStream stream(plan);
  for (int k = 0; k < 40; ++k) {
    stream.feed(0, 0.05 * k, 2.0 * 0.05 * k);
    stream.feed(1, 0.05 * k, 1600.0);
  }
  stream.finish();
  const std::vector<Row> rows = rows_of(stream);
  ASSERT_GT(rows.size(), 10U);
  EXPECT_NEAR(rows[10].x[0], rows[10].t, 1e-9);
  EXPECT_EQ(rows[10].x[1], 1400.0);
  EXPECT_NEAR(rows[10].y[0], 1.0, 1e-9);
}

// A row between two samples needs the samples beside these two.
TEST(SampleStream, ACurveWaitsForTheSampleAfterTheNext) {
  StreamPlan plan = plan_of();
  plan.sources[0].between = Interpolation::curve;
  plan.targets.clear();
  plan.derived.clear();
  SampleStream stream(plan);
  SignalHistory all(100, 0.0, plan.gap_s);
  for (int k = 0; k < 40; ++k) {
    all.add(0.15 * k, std::sin(0.9 * k));
  }
  std::vector<Row> rows;
  for (int k = 0; k < 40; ++k) {
    stream.feed(0, 0.15 * k, std::sin(0.9 * k));
    stream.feed(1, 0.15 * k, 1.0);
    std::ranges::move(rows_of(stream), std::back_inserter(rows));
  }
  ASSERT_GT(rows.size(), 50U);
  for (const Row& row : rows) {
    EXPECT_EQ(row.x[0], all.at(row.t, Interpolation::curve)) << row.t;
  }
}

TEST(SampleStream, ACentredDerivativeWaitsForHalfItsWindow) {
  SampleStream stream(plan_of(FilterWindow::centred));
  drive(stream, 0.0, 5.0);
  stream.feed(0, 5.0, 10.0);
  double newest = 0.0;
  while (const auto* const row = stream.next()) {
    newest = row->t;
  }
  stream.finish();
  const std::vector<Row> rows = rows_of(stream);
  ASSERT_FALSE(rows.empty());
  EXPECT_NEAR(rows[0].t, 4.8, 1e-9);
  EXPECT_TRUE(newest == 0.0 || newest <= 4.75);
}

TEST(SampleStream, NothingAllocatesAfterConstruction) {
  KELPIE_NEEDS_ALLOCATION_COUNT();
  StreamPlan plan = plan_of(FilterWindow::centred);
  plan.sources.push_back({.name = "v"});
  plan.sources.push_back({.name = "w"});
  plan.sources.push_back({.name = "r"});
  plan.vectors = {{{"u", "v", "w"}, Frame::frd, Frame::flu}};
  plan.lever_arm = {{"u", "v", "w"}, {"r", "r", "r"}, {0.1, 0.2, 0.3}};
  for (StreamPlan::Source& source : plan.sources) {
    source.keep = 32;
  }
  SampleStream stream(plan);
  RandomStream random(1, "messages");
  const std::size_t before = testing::allocations;
  std::size_t whole = 0;
  double t = 0.0;
  for (int k = 0; k < 100'000; ++k) {
    t += random.uniform() < 1e-3 ? 100.0 * random.normal() : 0.01;
    stream.feed(random.below(5), t + 0.03 * random.normal(), random.normal());
    while (const auto* const row = stream.next()) {
      whole += row->is_whole ? 1 : 0;
    }
  }
  EXPECT_EQ(testing::allocations, before);
  EXPECT_GT(whole, 1000U);
}

TEST(SampleStream, SaysWhatArrivedLateStuckOrNotAtAll) {
  SampleStream stream(plan_of());
  for (int k = 0; k < 100; ++k) {
    stream.feed(0, 0.05 * k, 7.0);
  }
  EXPECT_TRUE(rows_of(stream).empty());
  EXPECT_EQ(stream.silent_s(1), kInfinity);
  EXPECT_EQ(stream.signal(0).faults().stuck, 1U);
  stream.feed(1, 4.95, 1.0);
  stream.feed(0, 5.0, 7.0);
  stream.feed(0, 5.3, 7.0);
  EXPECT_EQ(stream.feed(0, 5.25, 8.0),
            SignalVerdict::used);  // no row has been made of what lies around
  EXPECT_NEAR(stream.silent_s(1), 0.35, 1e-9);
  EXPECT_FALSE(rows_of(stream).empty());
  EXPECT_EQ(stream.feed(0, 4.99, 7.0), SignalVerdict::late);
  EXPECT_EQ(stream.feed(0, 5.3, 8.0), SignalVerdict::repeated);
  EXPECT_EQ(stream.signal(0).faults().late, 1U);
  EXPECT_EQ(stream.signal(0).faults().duplicates, 1U);
  EXPECT_EQ(stream.signal(0).faults().steps_back, 1U);
}

TEST(SampleStream, StampsAndValuesThatAreNoneDoNothing) {
  SampleStream stream(plan_of());
  EXPECT_GT(drive(stream, 0.0, 10.0), 80U);
  for (const double stamp : {std::nan(""), kInfinity, -kInfinity, 1e300, -1e300}) {
    EXPECT_EQ(stream.feed(0, stamp, 1.0), SignalVerdict::no_stamp);
  }
  EXPECT_EQ(stream.feed(0, 10.0, std::nan("")), SignalVerdict::no_value);
  EXPECT_EQ(stream.feed(1, 10.0, kInfinity), SignalVerdict::no_value);
  EXPECT_EQ(stream.signal(0).faults().no_stamp, 5U);
  EXPECT_EQ(drive(stream, 10.0, 20.0), 100U);
  EXPECT_EQ(stream.restarts(), 0U);
}

// Rows go by the samples, not by the time between them.
TEST(SampleStream, ASilenceOfYearsHasNoRows) {
  SampleStream stream(plan_of());
  drive(stream, 0.0, 10.0);
  stream.feed(0, 1e9, 1.0);
  stream.feed(1, 1e9, 1.0);
  stream.feed(0, 1e9 + 2.0, 1.0);
  EXPECT_LT(rows_of(stream).size(), 50U);
}

TEST(SampleStream, AClockSetAnewBeginsAnewAndOneWrongStampDoesNot) {
  SampleStream stream(plan_of());
  drive(stream, 1000.0, 1010.0);
  stream.feed(0, 3.0, 1.0);  // far back, alone
  EXPECT_GT(drive(stream, 1010.0, 1020.0), 95U);
  EXPECT_EQ(stream.restarts(), 0U);
  EXPECT_GT(drive(stream, 5.0, 15.0), 70U);  // for good
  EXPECT_EQ(stream.restarts(), 1U);
  stream.feed(0, 1e8, 1.0);  // far ahead, alone
  EXPECT_GT(drive(stream, 15.0, 25.0), 70U);
  EXPECT_EQ(stream.restarts(), 2U);
}

TEST(SampleStream, SaysBeforehandThatASampleMakesItBeginAnew) {
  SampleStream stream(plan_of());
  drive(stream, 1000.0, 1010.0);
  for (std::size_t k = 1; k < 16; ++k) {  // eight messages of two sources
    EXPECT_FALSE(stream.begins_anew_with(5.0));
    stream.feed(k % 2, 5.0, 1.0);
  }
  EXPECT_FALSE(stream.begins_anew_with(1010.0));
  EXPECT_TRUE(stream.begins_anew_with(5.0));
  EXPECT_EQ(stream.restarts(), 0U);
  stream.begin_anew();
  EXPECT_FALSE(stream.begins_anew_with(5.0));
  EXPECT_GT(drive(stream, 1015.0, 1025.0), 85U);
  EXPECT_EQ(stream.restarts(), 1U);
}

TEST(SampleStream, RowsWhoseWindowReachesIntoAStuckStretchAreKnown) {
  const StreamPlan plan = plan_of(FilterWindow::centred);
  SampleStream stream(plan);
  std::vector<double> stuck;
  for (int k = 0; k < 200; ++k) {
    const double t = 0.05 * k;
    stream.feed(0, t, 4.0 <= t && t < 7.0 ? 1.0 : std::sin(t));
    stream.feed(1, t, 2.0);
    while (const SampleRow* const row = stream.next()) {
      if (stream.is_stuck(0, row->t)) {
        stuck.push_back(row->t);
      }
    }
  }
  ASSERT_FALSE(stuck.empty());
  EXPECT_GE(stuck.front(), 4.0 + plan.gap_s - plan.derivative.ahead_s());
  EXPECT_LE(stuck.front(), 4.0 + plan.gap_s + 0.3);
  EXPECT_NEAR(stuck.back(), 6.95 + plan.derivative.back_s(), 0.1);
  EXPECT_GE(stuck.back() + 1.0 / plan.rate_hz, 6.95 + plan.derivative.back_s());
}

TEST(SampleStream, WhatIsFedAfterTheEndBeginsAnew) {
  SampleStream stream(plan_of());
  drive(stream, 100.0, 110.0);
  stream.finish();
  rows_of(stream);
  EXPECT_GT(drive(stream, 0.0, 10.0), 85U);
  EXPECT_EQ(stream.restarts(), 0U);
}

// Where a ring is too short the rows say so, and nothing breaks.
TEST(SampleStream, WhatIsNotKeptIsMissing) {
  StreamPlan plan = plan_of();
  plan.sources[0].keep = 3;
  SampleStream stream(plan);
  EXPECT_EQ(drive(stream, 0.0, 10.0), 0U);
}

TEST(SampleStream, FramesAndLeverArmAreAsInALog) {
  StreamPlan plan;
  for (const char* const name : {"u", "v", "w", "p", "q", "r"}) {
    plan.sources.push_back({.name = name});
    plan.inputs.emplace_back(name);
  }
  plan.rate_hz = 10.0;
  plan.vectors = {{{"u", "v", "w"}, Frame::ned, Frame::enu}};
  plan.lever_arm = {{"u", "v", "w"}, {"p", "q", "r"}, {2.0, 0.0, 0.0}};
  SampleStream stream(plan);
  const std::vector<double> values{1.0, -0.5, -0.25, 0.0, 0.0, 0.1};
  for (int k = 0; k <= 50; ++k) {
    for (std::size_t source = 0; source < 3; ++source) {
      stream.feed(source, 0.05 * k, values[source]);
    }
    for (std::size_t source = 3; k % 2 == 0 && source < 6; ++source) {
      stream.feed(source, 0.05 * k + 0.01, values[source]);
    }
  }
  const std::vector<Row> rows = rows_of(stream);
  ASSERT_GT(rows.size(), 20U);
  EXPECT_EQ(rows[5].x, (std::vector<double>{-0.5, 1.0 - 0.1 * 2.0, 0.25, 0.0, 0.0, 0.1}));
}

// A vehicle that drives ahead at 1 m/s and turns at `rate`, its attitude beside its velocity over
// ground, 30 degrees apart from stamp to stamp at the most.
StreamPlan turning_plan(bool is_quaternion, bool is_in_degrees) {
  StreamPlan plan;
  plan.sources = {{.name = "u"}, {.name = "v"}, {.name = "w"}};
  std::vector<std::string> attitude{"phi", "theta", "psi"};
  if (is_quaternion) {
    attitude = {"qw", "qx", "qy", "qz"};
  }
  for (const std::string& name : attitude) {
    plan.sources.push_back({.name = name});
  }
  plan.vectors = {{.columns = {"u", "v", "w"},
                   .from = Frame::ned,
                   .to = Frame::frd,
                   .attitude = attitude,
                   .is_in_degrees = is_in_degrees}};
  plan.inputs = {"u", "v", "w"};
  plan.rate_hz = 10.0;
  return plan;
}

TEST(SampleStream, VelocitiesOfTheWorldAreTurnedByTheAttitudeBetweenItsSamples) {
  for (const auto& [is_quaternion, is_in_degrees] :
       {std::pair(false, false), std::pair(false, true), std::pair(true, false)}) {
    SampleStream stream(turning_plan(is_quaternion, is_in_degrees));
    const double yaw_rate = 2.0;
    const auto yaw_at = [&](double t) { return 3.0 + yaw_rate * t; };
    for (int k = 0; k < 200; ++k) {
      const double t = 0.05 * k;
      const double yaw = yaw_at(t);
      stream.feed(0, t, std::cos(yaw));
      stream.feed(1, t, std::sin(yaw));
      stream.feed(2, t, 0.5);
      const double told = t + 0.02;  // the attitude comes later, between two velocities
      const double psi = std::remainder(yaw_at(told), 2.0 * 3.14159265358979323846);
      if (is_quaternion) {
        stream.feed(3, told, std::cos(0.5 * psi));
        stream.feed(4, told, 0.0);
        stream.feed(5, told, 0.0);
        stream.feed(6, told, std::sin(0.5 * psi));
      } else {
        stream.feed(3, told, 0.0);
        stream.feed(4, told, 0.0);
        stream.feed(5, told, psi * (is_in_degrees ? 180.0 / 3.14159265358979323846 : 1.0));
      }
    }
    stream.finish();
    const std::vector<Row> rows = rows_of(stream);
    std::size_t whole = 0;
    for (const Row& row : rows) {
      if (row.is_whole) {
        ++whole;
        EXPECT_NEAR(row.x[0], 1.0, 2e-3) << row.t;
        EXPECT_NEAR(row.x[1], 0.0, 2e-3) << row.t;
        EXPECT_NEAR(row.x[2], 0.5, 1e-12);
      }
    }
    EXPECT_GT(whole, 90U);
  }
}

TEST(SampleStream, AVectorOfTheWorldWithoutOneOfItsPartsOrAnAttitudeIsMissing) {
  SampleStream stream(turning_plan(false, false));
  for (int k = 0; k < 100; ++k) {
    const double t = 0.1 * k;
    stream.feed(0, t, 1.0);
    if (k % 10 != 5) {
      stream.feed(1, t, 0.0);
    }
    stream.feed(2, t, k == 31 ? std::nan("") : 0.0);
    for (std::size_t part = 3; part < 6 && (k < 50 || k > 70); ++part) {
      stream.feed(part, t, 0.0);
    }
  }
  stream.finish();
  for (const Row& row : rows_of(stream)) {
    if (row.t > 5.95 && row.t < 6.05) {
      EXPECT_FALSE(row.is_whole) << "no attitude for a second before and behind";
    }
  }
  EXPECT_EQ(stream.signal(0).faults().samples, stream.signal(1).faults().samples);
  EXPECT_GT(stream.signal(0).faults().no_value, 10U);
}

TEST(SampleStream, AnAttitudeTurnsFromTheWorldToTheVehicle) {
  const auto refusal = [](auto change) {
    StreamPlan plan = turning_plan(false, false);
    change(plan.vectors[0]);
    return testing::message_of<InputError>([&] { SampleStream{plan}; });
  };
  EXPECT_EQ(refusal([](auto& vector) { vector.from = Frame::flu; }),
            "vectors: an attitude turns from NED or ENU to FRD or FLU");
  EXPECT_NE(refusal([](auto& vector) { vector.attitude.pop_back(); }).find("three angles"),
            std::string::npos);
  EXPECT_NE(refusal([](auto& vector) { vector.attitude[0] = "u"; }).find("turned itself"),
            std::string::npos);
  EXPECT_NE(refusal([](auto& vector) { vector.attitude[0] = "ph"; }).find("no state or command"),
            std::string::npos);
}

TEST(SampleStream, PlansThatCannotBeAreRefused) {
  const auto refusal = [](auto change) {
    StreamPlan plan = plan_of();
    change(plan);
    return testing::message_of<InputError>([&] { SampleStream{plan}; });
  };
  EXPECT_EQ(refusal([](StreamPlan&) {}), "");
  EXPECT_EQ(refusal([](StreamPlan& plan) { plan.sources[1].lag_s.reset(); }),
            "n: its lag has to be a number of s; one to be estimated takes a log");
  EXPECT_EQ(refusal([](StreamPlan& plan) { plan.inputs.clear(); }),
            "inputs: there have to be one or more");
  EXPECT_EQ(
      refusal([](StreamPlan& plan) { plan.targets = {"udotz"}; }),
      "targets: 'udotz' is no state, command or derivative (did you mean 'udot'?); there are u, "
      "n, udot");
  EXPECT_EQ(refusal([](StreamPlan& plan) { plan.wait_s = -1.0; }),
            "wait: -1 is out of range; it has to be 0 to 1e+06 s");
  EXPECT_EQ(refusal([](StreamPlan& plan) { plan.sources[0].keep = 0; }),
            "keep: has to be one sample or more");
}

}  // namespace
}  // namespace kelpie::sample_stream_test
