// SPDX-License-Identifier: Apache-2.0
// Velocities through outages of the velocity log, at the door where messages come in.
#include "live/live_reckoning.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <numbers>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "core/seconds.hpp"
#include "kelpie/core/error.hpp"
#include "live/checkpoint.hpp"
#include "live/engine.hpp"
#include "live/mission.hpp"
#include "live/pose_mission.hpp"
#include "support.hpp"

namespace kelpie::live_reckoning_test {
namespace {

using testing::kSecond;
using testing::little_mission;
using testing::Recorded;

constexpr std::int64_t kBegin = 1'700'000'000 * kSecond;

// The messages, as a vehicle sends them or as a recording has them. A vehicle takes its time: the
// learner is never far behind.
class Messages final : public live::Transport {
 public:
  Messages(const std::vector<bag::Topic>& topics, std::vector<Recorded> messages,
           std::optional<log::Reach> reach)
      : topics_(topics), messages_(std::move(messages)), reach_(reach) {}

  std::function<bool()> is_behind;

  const std::vector<bag::Topic>& topics() const override { return topics_; }
  std::optional<log::Reach> reach() const override { return reach_; }
  Got next(bag::Message& message, std::chrono::milliseconds /*timeout*/) override {
    while (!reach_ && is_behind()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    if (at_ == messages_.size()) {
      return Got::end;
    }
    message = testing::message_of(messages_[at_++]);
    return Got::message;
  }

 private:
  const std::vector<bag::Topic>& topics_;
  std::vector<Recorded> messages_;
  std::optional<log::Reach> reach_;
  std::size_t at_ = 0;
};

// One estimate of surge.
struct Estimate {
  std::int64_t data_ns = 0;
  double u = 0.0;
  double heading = 0.0;
  double deviation = 0.0;
  double silent_s = 0.0;
  double step = 0.0;
  VelocityFault fault = VelocityFault::none;

  bool operator==(const Estimate&) const = default;
  double t_s() const { return seconds(data_ns - kBegin); }
};

class Listener final : public live::Output {
 public:
  Listener(std::string& text, std::vector<Estimate>& estimates)
      : text_(text), estimates_(estimates) {}
  void event(const std::string& line) override { text_ += line + "\n"; }
  void reckoned(const live::ReckonedSample& sample) override {
    const DeadReckoning& reckoning = sample.reckoning;
    estimates_.push_back({.data_ns = sample.data_ns,
                          .u = reckoning.velocity(0),
                          .heading = reckoning.heading(),
                          .deviation = reckoning.deviation(0),
                          .silent_s = reckoning.silent_s(),
                          .step = reckoning.step(),
                          .fault = reckoning.fault(0)});
  }

 private:
  std::string& text_;
  std::vector<Estimate>& estimates_;
};

bool is_between(const Recorded& message, double from_s, double to_s) {
  const double t = static_cast<double>(message.receive_ns - kBegin) / 1e9;
  return from_s <= t && t < to_s;
}

double velocity_of(const Recorded& message) {
  double value = 0.0;
  std::memcpy(&value, message.data.data() + message.data.size() - 6 * sizeof(double),
              sizeof(double));
  return value;
}

// A velocity of another value, whose linear.y is `y`.
void set_velocity(Recorded& message, double u, double y = 0.0) {
  std::byte* const x = message.data.data() + message.data.size() - 6 * sizeof(double);
  std::memcpy(x, &u, sizeof(u));
  std::memcpy(x + sizeof(u), &y, sizeof(y));
}

class Reckoning : public ::testing::Test {
 protected:
  live::Health run(const std::vector<Recorded>& messages, bool is_replay = false,
                   const std::string& live = "") {
    return run_as(testing::mission_config("clock = \"header\"", "align = \"none\"\n" + live),
                  testing::mission_topics(), messages, is_replay);
  }

  live::Health run_as(const std::string& toml, const std::vector<bag::Topic>& topics,
                      const std::vector<Recorded>& messages, bool is_replay) {
    testing::write_text(folder_ / "x.toml", toml);
    const live::Configuration configuration = live::read_configuration(folder_ / "x.toml", {});
    std::optional<log::Reach> reach;
    if (is_replay) {
      reach = log::Reach{
          .origin_ns = topics.front().name == "/odom" ? kBegin + 3 * kSecond / 1000 : kBegin,
          .end_s = 1000.0};
    }
    Messages transport(topics, messages, reach);
    live::Outputs outputs;
    std::vector<std::unique_ptr<live::Output>> list;
    estimates_.clear();
    said_.clear();
    list.push_back(std::make_unique<Listener>(said_, estimates_));
    outputs.use(std::move(list));
    live::Requests requests;
    live::Engine engine(
        configuration, folder_.path(), transport,
        goes_on_ ? live::find_checkpoint(folder_.path(), configuration) : std::nullopt, outputs,
        requests);
    transport.is_behind = [&] { return engine.health().rows_waiting > 0; };
    engine.run([] { return live::Engine::Action::proceed; });
    return engine.health();
  }

  // The measured velocities of the undisturbed mission, by the estimate nearest in time.
  double largest_error(double from_s, double to_s) const {
    double largest = 0.0;
    std::size_t next = 0;
    for (const Recorded& message : mission_) {
      if (message.topic != 0 || !is_between(message, from_s, to_s)) {
        continue;
      }
      const double t = static_cast<double>(message.receive_ns - kBegin) / 1e9 - 0.01;
      while (next + 1 < estimates_.size() && estimates_[next].t_s() < t) {
        ++next;
      }
      largest = std::max(largest, std::abs(estimates_[next].u - velocity_of(message)));
    }
    return largest;
  }

  double first_fault_s(VelocityFault fault) const {
    const auto found = std::ranges::find(estimates_, fault, &Estimate::fault);
    return found == estimates_.end() ? std::nan("") : found->t_s();
  }

  double largest_step() const { return std::ranges::max(estimates_, {}, &Estimate::step).step; }

  testing::TemporaryFolder folder_;
  bool goes_on_ = false;  // with the model of the run before
  std::vector<Recorded> mission_ = little_mission(120.0);
  std::string said_;
  std::vector<Estimate> estimates_;
};

TEST_F(Reckoning, ALogWithHolesGivesTheNumbersOfTheLiveRun) {
  std::vector<Recorded> messages = mission_;
  std::erase_if(messages, [](const Recorded& m) {
    return m.topic == 0 && (is_between(m, 60, 65) || is_between(m, 80, 100));
  });
  run(messages);
  const std::vector<Estimate> live = estimates_;
  ASSERT_GT(live.size(), 1000U);
  EXPECT_LT(largest_error(80, 100), 0.1);
  EXPECT_LE(largest_step(), 3.0 + 1e-9);
  const auto longest = std::ranges::max(live, {}, &Estimate::silent_s);
  EXPECT_NEAR(longest.silent_s, 20.0, 0.2);
  EXPECT_NE(said_.find("the velocity log measures nothing; velocities are reckoned"),
            std::string::npos)
      << said_;
  EXPECT_NE(said_.find("velocities are measured again, after 20."), std::string::npos) << said_;
  run(messages, true);
  EXPECT_EQ(estimates_.size(), live.size());
  EXPECT_TRUE(estimates_ == live);
}

TEST_F(Reckoning, ExactZerosAreRecognisedAndNotLearned) {
  std::vector<Recorded> messages = mission_;
  for (Recorded& message : messages) {
    if (message.topic == 0 && is_between(message, 80, 100)) {
      set_velocity(message, 0.0);
    }
  }
  const live::Health health = run(messages);
  EXPECT_GE(first_fault_s(VelocityFault::zero), 79.9);
  EXPECT_LE(first_fault_s(VelocityFault::zero), 81.0);
  EXPECT_LT(largest_error(80, 100), 0.1);
  EXPECT_LE(largest_step(), 3.0 + 1e-9);
  EXPECT_GT(health.learner.rows_stuck, 190U);
  EXPECT_EQ(health.reckoning.outages, 1U);
  EXPECT_NEAR(health.reckoning.longest_s, 20.0, 0.2);
  EXPECT_NE(said_.find("exact zeros; velocities are reckoned"), std::string::npos) << said_;
}

TEST_F(Reckoning, AFrozenLogIsRecognised) {
  std::vector<Recorded> messages = mission_;
  double last = 0.0;
  for (Recorded& message : messages) {
    if (message.topic == 0 && is_between(message, 80, 100)) {
      set_velocity(message, last);
    } else if (message.topic == 0) {
      last = velocity_of(message);
    }
  }
  run(messages);
  EXPECT_GE(first_fault_s(VelocityFault::frozen), 80.0);
  EXPECT_LE(first_fault_s(VelocityFault::frozen), 81.0);
  EXPECT_LT(largest_error(80, 100), 0.1);
  EXPECT_LE(largest_step(), 3.0 + 1e-9);
}

// The message's own word counts, whatever number stands beside.
TEST_F(Reckoning, AMessageThatCallsItselfInvalidIsNotUsed) {
  std::vector<Recorded> messages = mission_;
  for (Recorded& message : messages) {
    if (message.topic == 0) {
      const bool is_valid = !is_between(message, 80, 100);
      set_velocity(message, is_valid ? velocity_of(message) : 0.77, is_valid ? 1.0 : 0.0);
    }
  }
  const std::string valid = "[live.valid]\n\"/odom:twist.linear.y\" = 1\n";
  const live::Health health = run(messages, false, valid);
  EXPECT_NEAR(static_cast<double>(health.sources[0].faults.no_value), 400.0, 3.0);
  EXPECT_LT(largest_error(80, 100), 0.1);
  EXPECT_GT(health.rows_incomplete, 170U);
  EXPECT_EQ(testing::message_of<InputError>([&] {
              run(messages, false, "[live.valid]\n\"twist\" = 1\n");
            }).find("live.valid.twist") != std::string::npos,
            true);
}

// The model has pulses as commands at first, then efforts: the velocity does not go from one to the
// other.
TEST_F(Reckoning, AnAlignmentThatIsFoundMakesNoStep) {
  std::vector<Recorded> messages = little_mission(200.0);
  for (Recorded& message : messages) {
    if (message.topic == 1) {
      set_velocity(message, 1500.0 + 30.0 * velocity_of(message));
    }
  }
  run_as(testing::mission_config("clock = \"header\""), testing::mission_topics(), messages, false);
  EXPECT_NE(said_.find("rests at 1500"), std::string::npos) << said_;
  double largest = 0.0;
  for (std::size_t i = 1; i < estimates_.size(); ++i) {
    largest = std::max(largest, std::abs(estimates_[i].u - estimates_[i - 1].u));
  }
  EXPECT_LT(largest, 0.1);
}

// For 20 s, beyond all belief.
TEST_F(Reckoning, ALogThatContradictsTheEstimateIsAnOutage) {
  std::vector<Recorded> messages = mission_;
  std::size_t count = 0;
  for (Recorded& message : messages) {
    if (message.topic == 0 && is_between(message, 80, 100)) {
      const double wild = 3.0 + 0.01 * static_cast<double>(++count);
      set_velocity(message, count % 2 == 0 ? wild : -wild);
    }
  }
  const live::Health health = run(messages);
  EXPECT_NE(said_.find("the velocity log contradicts the estimate; velocities are reckoned"),
            std::string::npos)
      << said_;
  EXPECT_NE(said_.find("velocities are measured again, after 20."), std::string::npos) << said_;
  EXPECT_EQ(health.reckoning.outages, 1U);
}

// Noise around a wrong value, beyond all belief: each moves the estimate little.
TEST_F(Reckoning, WildVelocitiesMoveLittle) {
  std::vector<Recorded> messages = mission_;
  std::size_t count = 0;
  for (Recorded& message : messages) {
    if (message.topic == 0 && is_between(message, 80, 100) && ++count % 2 == 0) {
      set_velocity(message, count % 4 == 0 ? 3.0 + 0.01 * static_cast<double>(count)
                                           : -3.0 - 0.01 * static_cast<double>(count));
    }
  }
  run(messages);
  EXPECT_LT(largest_error(80, 100), 0.1);
  EXPECT_LE(largest_step(), 3.0 + 1e-9);
  EXPECT_FALSE(std::isnan(first_fault_s(VelocityFault::implausible)));
}

// The velocity log goes on, and is to blame for nothing.
TEST_F(Reckoning, WithoutCommandsTheEstimateFollowsTheVelocityLog) {
  std::vector<Recorded> messages = mission_;
  std::erase_if(messages, [](const Recorded& m) { return m.topic == 1 && is_between(m, 80, 100); });
  const live::Health health = run(messages);
  EXPECT_LT(largest_error(80, 120), 0.2);
  const std::vector<Estimate> live = estimates_;
  const auto silent = std::ranges::count_if(live, [](const Estimate& one) {
    return 82.0 < one.t_s() && one.t_s() < 99.0 && one.silent_s < 0.2;
  });
  EXPECT_GT(silent, 300);
  EXPECT_EQ(health.reckoning.outages, 0U);
  EXPECT_EQ(health.reckoning.fault, "");
  EXPECT_EQ(said_.find("measures nothing"), std::string::npos) << said_;
  EXPECT_EQ(said_.find("measured again"), std::string::npos) << said_;
  run(messages, true);
  EXPECT_TRUE(estimates_ == live);
}

TEST_F(Reckoning, WithNeitherCommandsNorVelocitiesThereIsNoEstimate) {
  std::vector<Recorded> messages = mission_;
  std::erase_if(messages, [](const Recorded& m) { return m.topic == 1 && is_between(m, 80, 100); });
  for (Recorded& message : messages) {
    if (message.topic == 0 && is_between(message, 85, 95)) {
      set_velocity(message, std::nan(""));
    }
  }
  live::Health health = run(messages);
  EXPECT_TRUE(std::ranges::none_of(
      estimates_, [](const Estimate& one) { return 86.5 < one.t_s() && one.t_s() < 94.9; }));
  EXPECT_LT(largest_error(95.5, 120), 0.2);
  EXPECT_EQ(health.reckoning.outages, 0U);
  EXPECT_NE(said_.find("s: an input is silent and no velocity is measured; velocities are unknown"),
            std::string::npos)
      << said_;
  EXPECT_NE(said_.find("velocities are known again"), std::string::npos) << said_;
  std::erase_if(messages, [](const Recorded& m) { return is_between(m, 94, 1000); });
  health = run(messages);
  ASSERT_EQ(health.reckoning.velocities.size(), 1U);
  EXPECT_TRUE(std::isnan(health.reckoning.velocities[0].value));
  EXPECT_TRUE(std::isnan(health.reckoning.velocities[0].deviation));
  EXPECT_NEAR(health.reckoning.silent_s, 9.0, 0.3);
  EXPECT_EQ(health.reckoning.fault, "an input is silent and no velocity is measured");
}

// Poses in place of velocities: the present is reckoned from a row that is half a window old.
class ReckoningFromPoses : public Reckoning {
 protected:
  // Root mean square of surge less the truth, at all estimates.
  double error(double from_s, double to_s) const {
    double sum = 0.0;
    std::size_t count = 0;
    for (const Estimate& one : estimates_) {
      const double t = one.t_s();
      if (from_s <= t && t < to_s) {
        const auto at = static_cast<std::size_t>(std::lround(10.0 * t));
        sum += std::pow(one.u - log_.samples.at(at).u, 2.0);
        ++count;
      }
    }
    return std::sqrt(sum / static_cast<double>(count));
  }

  testing::PoseLog log_{200.0};
};

TEST_F(ReckoningFromPoses, VelocitiesOfThePresentFollowTheCommands) {
  const std::vector<Recorded> messages = testing::pose_mission(log_, kBegin, 0.01);
  const std::string config = testing::pose_config("window = 2.4", "align = \"none\"");
  const live::Health health = run_as(config, testing::pose_topics(), messages, false);
  const std::vector<Estimate> live = estimates_;
  ASSERT_GT(live.size(), 500U);
  EXPECT_NEAR(health.row_late_s, 1.2, 0.3);
  EXPECT_NEAR(health.reckoning.silent_s, 1.2, 0.4);
  EXPECT_EQ(said_.find("reckoned"), std::string::npos) << said_;
  double late = 0.0;  // of a velocity held for half a window
  for (std::size_t k = 1000; k + 12 < log_.samples.size(); ++k) {
    late += std::pow(log_.samples[k + 12].u - log_.samples[k].u, 2.0);
  }
  late = std::sqrt(late / static_cast<double>(log_.samples.size() - 1012));
  EXPECT_LT(error(120.0, 200.0), 0.35 * late);
  run_as(config, testing::pose_topics(), messages, true);
  EXPECT_EQ(estimates_.size(), live.size());
  EXPECT_TRUE(estimates_ == live);
}

TEST_F(ReckoningFromPoses, ASilenceOfPosesIsAnOutage) {
  std::vector<Recorded> messages = testing::pose_mission(log_, kBegin, 0.01);
  std::erase_if(messages,
                [](const Recorded& m) { return m.topic == 0 && is_between(m, 120, 140); });
  const live::Health health = run_as(testing::pose_config("window = 4", "align = \"none\""),
                                     testing::pose_topics(), messages, false);
  EXPECT_NE(said_.find("no pose is measured; velocities are reckoned"), std::string::npos) << said_;
  EXPECT_EQ(health.reckoning.outages, 1U);
  EXPECT_LT(error(120.0, 140.0), 0.15);
}

TEST_F(ReckoningFromPoses, WithoutCommandsTheEstimateFollowsThePoses) {
  std::vector<Recorded> messages = testing::pose_mission(log_, kBegin, 0.01);
  std::erase_if(messages,
                [](const Recorded& m) { return m.topic == 1 && is_between(m, 120, 140); });
  const live::Health health = run_as(testing::pose_config("window = 2.4", "align = \"none\""),
                                     testing::pose_topics(), messages, false);
  std::set<double> values;
  for (const Estimate& one : estimates_) {
    if (122.0 < one.t_s() && one.t_s() < 139.0) {
      values.insert(one.u);
    }
  }
  EXPECT_GT(values.size(), 100U);
  EXPECT_EQ(health.reckoning.outages, 0U);
  EXPECT_EQ(said_.find("no pose is measured"), std::string::npos) << said_;
}

// A vehicle in the plane in a constant current, with a compass.
class ReckoningInACurrent : public Reckoning {
 protected:
  static constexpr double kSpeed = 0.2;    // m/s of the water
  static constexpr double kTowards = 2.2;  // rad, of the heading
  static const std::vector<bag::Topic>& topics() {
    static const std::vector<bag::Topic> topics{
        {.name = "/dvl", .type = "geometry_msgs/msg/TwistStamped"},
        {.name = "/thruster", .type = "geometry_msgs/msg/TwistStamped"},
        {.name = "/compass", .type = "geometry_msgs/msg/TwistStamped"},
    };
    return topics;
  }
  static std::string config(const std::string& live, const std::string& scale = "") {
    return "buffer = 60\nanchors = 20\n[log]\ninputs = [\"u\", \"v\", \"r\", \"n\", \"m\"]\n"
           "targets = [\"udot\", \"vdot\", \"rdot\"]\nrate = 5\nclock = \"header\"\n"
           "[log.states]\nu = \"/dvl:twist.linear.x\"\nv = \"/dvl:twist.linear.y\"\n"
           "r = \"/dvl:twist.linear.z\"\npsi = \"/compass:twist.linear.x\"\n[log.commands]\n"
           "n = \"/thruster:twist.linear.x\"\nm = \"/thruster:twist.linear.y\"\n[log.derived]\n"
           "udot = \"d(u)\"\nvdot = \"d(v)\"\nrdot = \"d(r)\"\n" +
           scale + "[live]\nalign = \"none\"\n" + live;
  }

  // In steps of 0.02 s: velocities at 10 Hz, commands at 5 Hz, the compass at 5 Hz, which counts
  // with the yaw rate or against it, with noise.
  static std::vector<Recorded> drive(double seconds, double speed, double sense = 1.0,
                                     std::int64_t begin_ns = kBegin) {
    RandomStream random(11, "current");
    std::vector<Recorded> messages;
    double u = 0.0, v = 0.0, r = 0.0, psi = 0.4, n = 0.0, m = 0.0;
    for (int k = 0; k < static_cast<int>(50.0 * seconds); ++k) {
      const std::int64_t stamp = begin_ns + k * (kSecond / 50);
      const double t = 0.02 * k;
      if (k % 10 == 0) {
        n = 1.0 + 0.8 * std::sin(0.11 * t) + 0.5 * std::sin(0.37 * t);
        m = 0.6 * std::sin(0.05 * t) + 0.6 * std::sin(0.23 * t) + 0.2;
        messages.push_back({1, stamp + 1'000'000, twist_of(stamp, {n, m, 0.0})});
      }
      if (k % 5 == 1) {
        messages.push_back({0, stamp + 2'000'000,
                            twist_of(stamp, {u + 5e-3 * random.normal(), v + 5e-3 * random.normal(),
                                             r + 2e-3 * random.normal()})});
      }
      if (k % 10 == 3) {
        const double reading = std::remainder(psi + 0.02 * random.normal(), 2.0 * std::numbers::pi);
        messages.push_back({2, stamp + 3'000'000, twist_of(stamp, {sense * reading, 0.0, 0.0})});
      }
      // Forces are those of the velocity through the water, which turns in the body.
      const double cu = speed * std::cos(kTowards - psi);
      const double cv = speed * std::sin(kTowards - psi);
      const double ur = u - cu;
      const double vr = v - cv;
      u += 0.02 * (0.2 * n - 0.4 * ur * std::abs(ur) - 0.2 * ur + r * vr + r * cv);
      v += 0.02 * (-1.2 * vr * std::abs(vr) - 0.5 * vr - r * ur - r * cu);
      r += 0.02 * (0.3 * m - 0.8 * r - 0.3 * r * std::abs(r));
      psi += 0.02 * r;
    }
    std::ranges::stable_sort(messages, {}, &Recorded::receive_ns);
    return messages;
  }
  static testing::Bytes twist_of(std::int64_t stamp_ns, const std::array<double, 3>& linear) {
    testing::CdrMessage message;
    message.header(static_cast<std::int32_t>(stamp_ns / kSecond),
                   static_cast<std::uint32_t>(stamp_ns % kSecond));
    for (const double value : linear) {
      message.add(value);
    }
    return message.add(0.0).add(0.0).add(0.0).bytes();
  }
  static double off_by(double degrees, double towards) {
    return std::abs(std::remainder(degrees - towards * 180.0 / std::numbers::pi, 360.0));
  }

  // Later, with what was learned in calm water.
  live::Health run_in_current(double sense) {
    std::vector<Recorded> messages = drive(300.0, kSpeed, sense, kBegin + 1000 * kSecond);
    std::erase_if(messages,
                  [](const Recorded& m) { return m.topic == 0 && is_between(m, 1240, 1260); });
    return run_as(config("heading = \"psi\"\n"), topics(), messages, false);
  }
  void learn_in_calm_water(double sense) {
    run_as(config("heading = \"psi\"\n"), topics(), drive(400.0, 0.0, sense), false);
    goes_on_ = true;
  }
};

TEST_F(ReckoningInACurrent, FindsItInTheAxesOfTheHeading) {
  learn_in_calm_water(1.0);
  const live::Health health = run_in_current(1.0);
  EXPECT_NEAR(health.reckoning.current_speed, kSpeed, 0.2 * kSpeed);
  EXPECT_LT(off_by(health.reckoning.current_direction, kTowards), 10.0)
      << health.reckoning.current_direction;
}

TEST_F(ReckoningInACurrent, ALogWithAHoleGivesTheHeadingsOfTheLiveRun) {
  std::vector<Recorded> messages = drive(150.0, kSpeed);
  const auto is_compass = [](const Recorded& m) { return m.topic == 2; };
  const double compass =
      velocity_of(*std::ranges::find_if(messages.rbegin(), messages.rend(), is_compass));
  std::erase_if(messages, [](const Recorded& m) { return m.topic == 0 && is_between(m, 80, 100); });
  run_as(config("heading = \"psi\"\n"), topics(), messages, false);
  const std::vector<Estimate> live = estimates_;
  ASSERT_GT(live.size(), 1000U);
  EXPECT_NEAR(std::remainder(live.back().heading - compass, 2.0 * std::numbers::pi), 0.0, 0.1);
  run_as(config("heading = \"psi\"\n"), topics(), messages, true);
  EXPECT_EQ(estimates_.size(), live.size());
  EXPECT_TRUE(estimates_ == live);
}

TEST_F(ReckoningInACurrent, ACompassThatCountsAgainstTheYawRateTellsTheDirectionAsItCounts) {
  learn_in_calm_water(-1.0);
  const live::Health health = run_in_current(-1.0);
  EXPECT_NEAR(health.reckoning.current_speed, kSpeed, 0.2 * kSpeed);
  EXPECT_LT(off_by(health.reckoning.current_direction, -kTowards), 10.0)
      << health.reckoning.current_direction;
}

TEST_F(ReckoningInACurrent, WithoutAHeadingItHasNoDirection) {
  const live::Health health = run_as(config(""), topics(), drive(120.0, kSpeed), false);
  EXPECT_FALSE(std::isnan(health.reckoning.current_speed));
  EXPECT_TRUE(std::isnan(health.reckoning.current_direction));
  EXPECT_EQ(said_.find("isn't used as a heading"), std::string::npos) << said_;
}

TEST_F(ReckoningInACurrent, DegreesAreNotTakenForRadians) {
  const live::Health health =
      run_as(config("heading = \"psi\"\n", "[log.scale]\npsi = 57.29577951\n"), topics(),
             drive(120.0, kSpeed), false);
  EXPECT_TRUE(std::isnan(health.reckoning.current_direction));
  EXPECT_NE(said_.find("WARNING: psi turns "), std::string::npos) << said_;
}

}  // namespace
}  // namespace kelpie::live_reckoning_test
