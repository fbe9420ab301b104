// SPDX-License-Identifier: Apache-2.0
#include "autopilot/reporter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "autopilot/rov.hpp"

namespace kelpie::reporter_test {
namespace {

// What a ground station makes of it after some seconds.
class Station {
 public:
  explicit Station(autopilot::Reporter& reporter) : reporter_(reporter) {}

  void wait(double seconds) {
    const auto end = now_ + std::chrono::milliseconds(static_cast<int>(1e3 * seconds));
    for (; now_ < end; now_ += std::chrono::milliseconds(10)) {
      reporter_.send_due(now_, 5.0, writer_,
                         [&](auto bytes) { rov.hear(bytes, [](auto /*bytes*/) {}); });
    }
  }

  testing::Rov rov;

 private:
  autopilot::Reporter& reporter_;
  autopilot::Reporter::Time now_{std::chrono::hours(1)};
  mavlink::FrameWriter writer_{1};
};

void predict(autopilot::Reporter& reporter, const std::vector<double>& values) {
  std::vector<Prediction> predictions(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    predictions[i].value = values[i];
  }
  reporter.predicted({.stamp_ns = 0, .x = {}, .predictions = predictions});
}

TEST(Reporter, NamesHaveTenLettersAndNoneIsThereTwice) {
  const autopilot::Reporter reporter({"udot", "surge_acceleration", "surge_acceleration_true"});
  EXPECT_EQ(reporter.names(), (std::vector<std::string>{"udot", "surge_acce", "surge_acc2"}));
}

TEST(Reporter, TheNewestPredictionsAreSentSomeTimesASecond) {
  autopilot::Reporter reporter({"udot", "vdot"});
  Station station(reporter);
  for (int k = 0; k < 100; ++k) {
    predict(reporter, {0.5 * k, std::numeric_limits<double>::quiet_NaN()});
    station.wait(0.02);
  }
  EXPECT_GT(station.rov.heard["NAMED_VALUE_FLOAT"], 2 * 7);
  EXPECT_LE(station.rov.heard["NAMED_VALUE_FLOAT"], 2 * 11);
  EXPECT_GT(station.rov.values["udot"], 40.0);
  EXPECT_TRUE(std::isnan(station.rov.values["vdot"]));
  const int before = station.rov.heard["NAMED_VALUE_FLOAT"];
  station.wait(2.0);  // nothing new
  EXPECT_LE(station.rov.heard["NAMED_VALUE_FLOAT"], before + 2);
}

TEST(Reporter, TheMainNumbersOfTheHealthGoWithPredictions) {
  autopilot::Reporter reporter({"udot"});
  Station station(reporter);
  live::Health health;
  health.learner.learned = 250;
  health.rows_dropped = 3;
  reporter.health(health);
  predict(reporter, {0.5});
  station.wait(1.0);
  EXPECT_EQ(station.rov.values["learned"], 250.0);
  EXPECT_EQ(station.rov.values["rows_lost"], 3.0);
  EXPECT_EQ(station.rov.values["msgs_lost"], 0.0);
  EXPECT_EQ(station.rov.heard["NAMED_VALUE_FLOAT"], 1 + 5);
  health.learner.countdown = "1 of 2 parameters known";
  health.learner.parameters.resize(2);
  health.learner.parameters_known = 1;
  reporter.health(health);
  predict(reporter, {0.5});
  station.wait(1.0);
  EXPECT_EQ(station.rov.values["par_known"], 1.0);
  EXPECT_EQ(station.rov.values["par_asked"], 2.0);
}

TEST(Reporter, LongTextsComeInPiecesAndAFloodIsDropped) {
  autopilot::Reporter reporter({"udot"});
  Station station(reporter);
  reporter.event(std::string(92, 'a'));  // with what stands before it 100: two full messages
  station.wait(3.0);
  EXPECT_EQ(station.rov.texts,
            "kelpie: " + std::string(42, 'a') + "\n" + std::string(50, 'a') + "\n\n");
  station.rov.texts.clear();
  for (int k = 0; k < 100; ++k) {
    reporter.event("u is silent");
  }
  station.wait(60.0);
  EXPECT_LT(station.rov.texts.size(), 200U);
  reporter.event("hull touched");
  station.wait(2.0);
  EXPECT_TRUE(station.rov.texts.ends_with("kelpie: hull touched\n")) << station.rov.texts;
}

// A ground station shows and speaks warnings.
TEST(Reporter, AWarningIsSentAsOne) {
  autopilot::Reporter reporter({"udot"});
  Station station(reporter);
  const auto severity_of = [&](const std::string& line) {
    reporter.event(line);
    station.wait(2.0);
    return station.rov.field("STATUSTEXT", "severity");
  };
  EXPECT_EQ(severity_of("u is silent"), 5.0);
  EXPECT_EQ(
      severity_of("at 60.0 s: WARNING: NEARLY NO AUTHORITY left in sway; th3 gives 0 % of its "
                  "thrust: surge 1.00, sway 0.00 of nominal left"),
      4.0);
  EXPECT_EQ(severity_of("u speaks again"), 5.0);
}

// A vehicle without drag at constant speed, all of which is known.
DeadReckoning at_speed(double u, double v, double r) {
  OpenLoop loop;
  loop.accelerations = [](std::span<const double> /*x*/, std::span<double> a) {
    std::ranges::fill(a, 0.0);
  };
  loop.states = {0, 1, 2};
  loop.error = {0.01, 0.01, 0.01};
  loop.error_time_s = {1.0, 1.0, 1.0};
  loop.noise = {0.02, 0.02, 0.01};
  loop.seen = {{-1.0, 1.0}, {-1.0, 1.0}, {-1.0, 1.0}};
  DeadReckoning reckoning(loop);
  reckoning.update(std::array{u, v, r}, 0.0);
  return reckoning;
}

TEST(Reporter, VelocitiesGoAsTheWayOfAVelocityLogOrAsOdometry) {
  const std::vector<std::string> names{"u", "v", "r"};
  const DeadReckoning reckoning = at_speed(0.4, 0.1, -0.2);
  for (const bool is_frd : {true, false}) {
    const double sign = is_frd ? 1.0 : -1.0;  // of sway and yaw
    for (const auto how :
         {autopilot::VelocityMessage::delta, autopilot::VelocityMessage::odometry}) {
      autopilot::Reporter reporter({"udot", "vdot", "rdot"}, how, is_frd);
      Station station(reporter);
      for (std::int64_t k = 0; k < 100; ++k) {
        reporter.reckoned({.stamp_ns = 0,
                           .data_ns = 1'700'000'000'000'000'000 + k * 20'000'000,
                           .names = names,
                           .reckoning = reckoning});
        station.wait(0.02);
      }
      if (how == autopilot::VelocityMessage::delta) {
        EXPECT_GT(station.rov.heard["VISION_POSITION_DELTA"], 25);
        EXPECT_LE(station.rov.heard["VISION_POSITION_DELTA"], 40);  // 20 a second
        const auto field = [&](const char* of, std::size_t index = 0) {
          return station.rov.field("VISION_POSITION_DELTA", of, index);
        };
        const double time_s = 1e-6 * field("time_delta_usec");
        EXPECT_NEAR(field("position_delta", 0), 0.4 * time_s, 1e-6);
        EXPECT_NEAR(field("position_delta", 1), sign * 0.1 * time_s, 1e-6);
        EXPECT_NEAR(field("angle_delta", 2), sign * -0.2 * time_s, 1e-6);
        EXPECT_EQ(field("confidence"), 100.0);
      } else {
        const auto field = [&](const char* of, std::size_t index = 0) {
          return station.rov.field("ODOMETRY", of, index);
        };
        EXPECT_EQ(field("child_frame_id"), 12.0);
        EXPECT_NEAR(field("vx"), 0.4, 1e-6);
        EXPECT_NEAR(field("vy"), sign * 0.1, 1e-6);
        EXPECT_NEAR(field("yawspeed"), sign * -0.2, 1e-6);
        EXPECT_TRUE(std::isnan(field("x")));
        EXPECT_TRUE(std::isnan(field("vz")));  // no state of the model
        EXPECT_TRUE(std::isnan(field("pitchspeed")));
        EXPECT_NEAR(field("velocity_covariance", 0), 4e-4, 1e-9);   // of u
        EXPECT_TRUE(std::isnan(field("velocity_covariance", 11)));  // of w: unknown
        EXPECT_NEAR(field("velocity_covariance", 20), 1e-4, 1e-9);  // of r
      }
    }
  }
  autopilot::Reporter silent({"udot", "vdot", "rdot"});
  Station station(silent);
  silent.reckoned({.stamp_ns = 0, .data_ns = 1, .names = names, .reckoning = reckoning});
  station.wait(1.0);
  EXPECT_TRUE(station.rov.heard.empty());
}

}  // namespace
}  // namespace kelpie::reporter_test
