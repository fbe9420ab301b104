// SPDX-License-Identifier: Apache-2.0
// What happens at sea, at the door where messages come in: counted, said, and learning goes on.
#include "live/engine.hpp"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <deque>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/seconds.hpp"
#include "kelpie/core/error.hpp"
#include "live/checkpoint.hpp"
#include "live/mission.hpp"
#include "live/tuning.hpp"
#include "support.hpp"
#include "vehicle/four_thrusters.hpp"

namespace kelpie::engine_test {
namespace {

using testing::kSecond;
using testing::little_mission;
using testing::mission_config;
using testing::Recorded;
using testing::TemporaryFolder;

constexpr std::int64_t kBegin = 1'700'000'000 * kSecond;

// Messages as if they came from a vehicle: nothing is known of them beforehand.
class Vehicle final : public live::Transport {
 public:
  Vehicle(std::vector<bag::Topic> topics, std::vector<Recorded> messages)
      : topics_(std::move(topics)), messages_(std::move(messages)) {}

  const std::vector<bag::Topic>& topics() const override { return topics_; }
  std::optional<log::Reach> reach() const override { return recorded; }
  bool ends = true;
  std::optional<log::Reach> recorded{};  // with it a recording

  Got next(bag::Message& message, std::chrono::milliseconds /*timeout*/) override {
    if (at_ == messages_.size() && !ends) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      return Got::nothing;
    }
    if (at_ == messages_.size()) {
      return Got::end;
    }
    message = testing::message_of(messages_[at_++]);
    return Got::message;
  }

 private:
  std::vector<bag::Topic> topics_;
  std::vector<Recorded> messages_;
  std::size_t at_ = 0;
};

// What was learned, by its stamp.
using Samples = std::map<std::int64_t, std::array<double, 3>>;  // u, n, udot

class Listener final : public live::Output {
 public:
  Listener(std::string& text, Samples& samples) : text_(text), samples_(samples) {}
  void event(const std::string& line) override { text_ += line + "\n"; }
  void learned(const live::LearnedSample& sample) override {
    samples_[sample.stamp_ns] = {sample.x[0], sample.x[1], sample.y[0]};
  }

 private:
  std::string& text_;
  Samples& samples_;
};

class Live : public ::testing::Test {
 protected:
  // Takes the messages in; the health in the end.
  live::Health run(const std::vector<Recorded>& messages, const std::string& config,
                   const std::vector<bag::Topic>& topics = testing::mission_topics(),
                   bool goes_on = false) {
    testing::write_text(folder_ / "x.toml", config);
    const live::Configuration configuration = live::read_configuration(folder_ / "x.toml", {});
    Vehicle vehicle(topics, messages);
    live::Outputs outputs;
    std::vector<std::unique_ptr<live::Output>> list;
    samples_.clear();
    list.push_back(std::make_unique<Listener>(said_, samples_));
    outputs.use(std::move(list));
    live::Engine engine(
        configuration, folder_.path(), vehicle,
        goes_on ? live::find_checkpoint(folder_.path(), configuration) : std::nullopt, outputs,
        requests_);
    engine.run([] { return live::Engine::Action::proceed; });
    is_finite_ = false;
    if (engine.learner().model()->model().ready()) {
      double y = std::numeric_limits<double>::quiet_NaN();
      engine.learner().model()->predict(std::vector<double>{0.2, 5.0}, std::span(&y, 1));
      is_finite_ = std::isfinite(y);
    }
    return engine.health();
  }

  // A mission with stamps of its senders.
  live::Health run(const std::vector<Recorded>& messages) {
    return run(messages, mission_config("clock = \"header\"", "align = \"none\""));
  }

  // Learning went on when data were good again: the mission has 60 s of them and more.
  void expect_learned(const live::Health& health, std::size_t least) const {
    EXPECT_GE(health.learner.learned, least);
    EXPECT_EQ(health.rows_dropped, 0U);
    EXPECT_TRUE(is_finite_);
  }

  // From then on the samples are those of the mission undisturbed, to the rounding of its times.
  void expect_as_undisturbed_from(double t_s, std::size_t count) {
    const Samples disturbed = samples_;
    run(little_mission(80.0));
    std::size_t alike = 0;
    for (const auto& [stamp_ns, values] : disturbed) {
      if (stamp_ns < kBegin + nanoseconds(t_s)) {
        continue;
      }
      ASSERT_TRUE(samples_.contains(stamp_ns)) << stamp_ns;
      ++alike;
      for (std::size_t k = 0; k < values.size(); ++k) {
        EXPECT_NEAR(values[k], samples_[stamp_ns][k], 1e-11) << stamp_ns;
      }
    }
    EXPECT_EQ(alike, count);
  }

  TemporaryFolder folder_;
  live::Requests requests_;
  std::string said_;
  Samples samples_;
  bool is_finite_ = false;
};

bool is_between(const Recorded& message, double from_s, double to_s) {
  const double t = static_cast<double>(message.receive_ns - kBegin) / 1e9;
  return from_s <= t && t < to_s;
}

void set_stamp(Recorded& message, std::int64_t stamp_ns) {
  const testing::Bytes fresh = testing::twist_at(stamp_ns, 0.0);
  std::copy_n(fresh.begin(), 12, message.data.begin());
}

std::int64_t stamp_of(const Recorded& message) {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
  std::memcpy(&sec, message.data.data() + 4, sizeof(sec));
  std::memcpy(&nanosec, message.data.data() + 8, sizeof(nanosec));
  return sec * kSecond + nanosec;
}

void set_value(Recorded& message, double value) {
  const testing::Bytes fresh = testing::twist_at(stamp_of(message), value);
  message.data = fresh;
}

TEST_F(Live, LearnsWhatComes) {
  const live::Health health = run(little_mission(80.0));
  expect_learned(health, 780);
  EXPECT_LE(health.rows_incomplete, 20U);  // where signals begin and end
  EXPECT_EQ(health.sources[0].faults.late + health.sources[1].faults.late, 0U);
  EXPECT_GT(health.learner.axes[0].r2, 0.5);
}

TEST_F(Live, ATopicThatStopsIsASilence) {
  std::vector<Recorded> messages = little_mission(80.0);
  std::erase_if(messages, [](const Recorded& m) { return m.topic == 0 && is_between(m, 30, 40); });
  const live::Health health = run(messages);
  EXPECT_EQ(health.sources[0].faults.gaps, 1U);
  EXPECT_GT(health.rows_incomplete, 60U);
  expect_learned(health, 660);
}

TEST_F(Live, MessagesThatComeLateAreLeftOut) {
  std::vector<Recorded> messages = little_mission(80.0);
  std::size_t late = 0;
  for (Recorded& message : messages) {
    if (message.topic == 0 && ++late % 40 == 0) {
      message.receive_ns += kSecond;
    }
  }
  std::ranges::stable_sort(messages, {}, &Recorded::receive_ns);
  const live::Health health = run(messages);
  EXPECT_GE(health.sources[0].faults.late, late / 40 - 1);
  expect_learned(health, 700);
}

TEST_F(Live, RepeatedMessagesCountOnce) {
  std::vector<Recorded> messages;
  for (const Recorded& message : little_mission(80.0)) {
    messages.insert(messages.end(), 2, message);
  }
  const live::Health twice = run(messages);
  EXPECT_GT(twice.sources[0].faults.duplicates, 1500U);
  const std::string model = testing::read_text(folder_ / "model.json");
  run(little_mission(80.0));
  EXPECT_EQ(testing::read_text(folder_ / "model.json"), model);
}

TEST_F(Live, AClockThatGoesTo1970AndBackBeginsAnew) {
  std::vector<Recorded> messages = little_mission(80.0);
  for (Recorded& message : messages) {
    if (message.topic < 2 && is_between(message, 30, 40)) {
      set_stamp(message, stamp_of(message) - kBegin);
    }
  }
  const live::Health health = run(messages);
  EXPECT_EQ(health.clock_restarts, 1U);  // ahead again is a silence
  expect_learned(health, 740);
  EXPECT_GT(health.learner.axes[0].r2, 0.5);
  EXPECT_LT(health.learner.last_t_s, 100.0);
  expect_as_undisturbed_from(40.5, 393);
}

// A computer without a battery for its clock; counted from 1970, times of today are off by 0.2 µs.
TEST_F(Live, AClockThatBeginsIn1970CostsAMoment) {
  std::vector<Recorded> messages = little_mission(80.0);
  for (Recorded& message : messages) {
    if (message.topic < 2 && is_between(message, 0, 10)) {
      set_stamp(message, stamp_of(message) - kBegin);
    }
  }
  const live::Health health = run(messages);
  EXPECT_EQ(health.clock_restarts, 0U);
  expect_learned(health, 780);
  EXPECT_LT(health.sources[0].faults.longest_gap_s, 10.0);
  expect_as_undisturbed_from(10.5, 693);
  // And so does one that begins there again, with a checkpoint of the other time.
  const std::string config = mission_config("clock = \"header\"", "align = \"none\"");
  EXPECT_GT(run(messages, config, testing::mission_topics(), true).learner.learned, 1500U);
  expect_as_undisturbed_from(10.5, 693);
}

TEST_F(Live, AClockThatIsSetByAnHourCostsAMoment) {
  for (const std::int64_t by_s : {-3600, 3600}) {
    std::vector<Recorded> messages = little_mission(80.0);
    for (Recorded& message : messages) {
      if (message.topic < 2 && is_between(message, 40, 1000)) {
        set_stamp(message, stamp_of(message) + by_s * kSecond);
      }
    }
    const live::Health health = run(messages);
    EXPECT_EQ(health.clock_restarts, by_s < 0 ? 1U : 0U);
    expect_learned(health, 760);
  }
}

TEST_F(Live, ThreeMessagesAYearAheadCostAMoment) {
  for (const double apart_s : {0.0, 0.5, 5.0}) {
    std::vector<Recorded> messages = little_mission(80.0);
    double next_s = 30.0;
    int left = 3;
    for (Recorded& message : messages) {
      if (message.topic < 2 && left > 0 && is_between(message, next_s, 1000)) {
        --left;
        next_s += apart_s;
        set_stamp(message, stamp_of(message) + std::int64_t{365} * 86'400 * kSecond);
      }
    }
    const live::Health health = run(messages);
    expect_learned(health, 750);
    EXPECT_GT(health.learner.axes[0].r2, 0.5);
    EXPECT_LT(health.learner.last_t_s, 120.0);
  }
}

TEST_F(Live, AnotherRateIsLearnedAsWell) {
  std::vector<Recorded> messages = little_mission(80.0);
  std::size_t count = 0;
  std::erase_if(messages, [&](const Recorded& m) {
    return m.topic == 0 && is_between(m, 40, 1000) && ++count % 2 != 0;
  });
  expect_learned(run(messages), 770);
}

TEST_F(Live, AVelocityTooSlowForItsWindowIsTold) {
  std::vector<Recorded> messages = little_mission(80.0);
  std::size_t count = 0;
  std::erase_if(messages, [&](const Recorded& m) {
    return m.topic == 0 && is_between(m, 40, 1000) && ++count % 10 != 0;
  });
  const live::Health health = run(messages);
  EXPECT_EQ(health.no_rows,
            "no row has been whole for 10 s: u comes at 2.0 Hz, its window of 0.5 s needs 3 "
            "samples");
  EXPECT_NE(said_.find(health.no_rows), std::string::npos) << said_;
  EXPECT_EQ(run(little_mission(80.0)).no_rows, "");
}

TEST_F(Live, NumbersThatAreNoneAreLeftOut) {
  std::vector<Recorded> messages = little_mission(80.0);
  for (Recorded& message : messages) {
    if (message.topic == 0 && is_between(message, 30, 40)) {
      set_value(message, std::numeric_limits<double>::quiet_NaN());
    }
  }
  const live::Health health = run(messages);
  EXPECT_NEAR(static_cast<double>(health.sources[0].faults.no_value), 200.0, 2.0);
  expect_learned(health, 660);
}

TEST_F(Live, AFrozenVelocityIsNotLearned) {
  std::vector<Recorded> messages = little_mission(80.0);
  for (Recorded& message : messages) {
    if (message.topic == 0 && is_between(message, 30, 40)) {
      set_value(message, 0.123);
    }
  }
  const live::Health health = run(messages);
  EXPECT_EQ(health.sources[0].faults.stuck, 1U);
  EXPECT_GT(health.learner.rows_stuck, 80U);  // all but the gap, until which nobody knows
  // Nor a derivative that reaches into it, and to what it is afterwards.
  const auto after = samples_.upper_bound(kBegin + 32 * kSecond);
  EXPECT_GT(after->first, kBegin + nanoseconds(40.15));
  EXPECT_LT(after->first, kBegin + nanoseconds(40.45));
  EXPECT_NE(said_.find("a velocity is stuck"), std::string::npos);
  EXPECT_NE(said_.find("velocities change again"), std::string::npos);
  expect_learned(health, 680);
  EXPECT_EQ(
      run(messages, mission_config("clock = \"header\"", "align = \"none\"\nfrozen = \"learn\""))
          .learner.rows_stuck,
      0U);
}

// From 300 s on the thruster gives a quarter of its thrust: twice the command for the same effect.
TEST_F(Live, ADamagedThrusterLosesAuthority) {
  std::vector<Recorded> messages = little_mission(420.0);
  for (Recorded& message : messages) {
    if (message.topic == 1 && is_between(message, 300, 1000)) {
      double command = 0.0;
      const std::size_t place = message.data.size() - 6 * sizeof(double);
      std::memcpy(&command, message.data.data() + place, sizeof(command));
      set_value(message, 2.0 * command);
    }
  }
  const live::Health health = run(messages);
  ASSERT_NE(health.learner.effectiveness, nullptr);
  EXPECT_NEAR(health.learner.axes[0].authority, 0.25, 0.05);
  EXPECT_NE(health.learner.authority.find("n gives 2"), std::string::npos)
      << health.learner.authority;
  EXPECT_NE(said_.find("of its thrust: surge 0.2"), std::string::npos) << said_;
  EXPECT_EQ(said_.find("m/s from ahead"), std::string::npos) << said_;  // no unit is known
  // 0.25 · 0.01 · 20² m/s² ahead against 2 u² + 0.3 u.
  EXPECT_NEAR(health.learner.held_current, 0.63, 0.05);
}

// An operator hears of a learner that has failed, though messages never end.
TEST_F(Live, ALearnerThatFailsEndsTheRun) {
  class Failing final : public live::Output {
   public:
    void learned(const live::LearnedSample& /*sample*/) override { throw Failure("no more room"); }
  };
  testing::write_text(folder_ / "x.toml", mission_config("clock = \"header\"", "align = \"none\""));
  const live::Configuration configuration = live::read_configuration(folder_ / "x.toml", {});
  Vehicle vehicle(testing::mission_topics(), little_mission(80.0));
  vehicle.ends = false;
  live::Outputs outputs;
  Failing failing;
  outputs.add(failing);
  live::Engine engine(configuration, folder_.path(), vehicle, std::nullopt, outputs, requests_);
  constexpr int kEnough = 20'000;
  int asked = 0;
  const std::string why = testing::message_of<Failure>([&] {
    engine.run([&] {
      return ++asked < kEnough ? live::Engine::Action::proceed : live::Engine::Action::stop;
    });
  });
  EXPECT_EQ(why, "no more room");
  EXPECT_LT(asked, kEnough);
}

// Messages of a recording wait for a learner that takes its time.
TEST_F(Live, AReplayThatWaitsForItsLearnerIsNotIdle) {
  class Slow final : public live::Output {
   public:
    explicit Slow(std::string& said) : said_(said) {}
    void event(const std::string& line) override { said_ += line + "\n"; }
    void learned(const live::LearnedSample& /*sample*/) override {
      if (++learned_ == 100) {
        std::this_thread::sleep_for(
            std::chrono::duration<double>(live::kTuning.longest_idle_s + 0.5));
      }
    }

   private:
    std::string& said_;
    int learned_ = 0;
  };
  testing::write_text(folder_ / "x.toml", mission_config("clock = \"header\"", "align = \"none\""));
  const live::Configuration configuration = live::read_configuration(folder_ / "x.toml", {});
  Vehicle vehicle(testing::mission_topics(), little_mission(80.0));
  vehicle.recorded = log::Reach{.origin_ns = kBegin + 3 * kSecond / 1000, .end_s = 1000.0};
  live::Outputs outputs;
  Slow slow(said_);
  outputs.add(slow);
  live::Engine engine(configuration, folder_.path(), vehicle, std::nullopt, outputs, requests_);
  engine.run([] { return live::Engine::Action::proceed; });
  EXPECT_EQ(said_.find("no messages come"), std::string::npos) << said_;
  EXPECT_EQ(engine.health().idle_s, 0.0);
}

TEST(Authority, IsUnknownOnceItsDiagnosisIs) {
  live::Configuration configuration;
  configuration.plan.inputs = {"u", "n"};
  configuration.plan.targets = {"udot"};
  std::string said;
  Samples samples;
  Listener listener(said, samples);
  live::LearnerHealth health;
  health.authority = "u: 25 % of nominal left";
  health.held_current = 0.6;
  live::AuthorityReporter(configuration).update(nullptr, {}, 0.0, health, listener);
  EXPECT_EQ(health.authority, "");
  EXPECT_TRUE(std::isnan(health.held_current));
}

// A warning in the words of a pilot, in the unit that the log tells.
TEST(Authority, ALostAxisIsAWarning) {
  live::Configuration configuration;
  configuration.plan.inputs = testing::FourThrusters::kInputs;
  configuration.plan.targets = testing::FourThrusters::kTargets;
  configuration.log.roles.units = {{"u", "m/s"}};
  live::AuthorityReporter reporter(configuration);
  for (const double effort : {-4.0, 4.0}) {
    reporter.observe(std::array{0.0, 0.0, 0.0, effort, effort, effort, effort});
  }
  Diagnosis learned = testing::FourThrusters::diagnosis();
  testing::FourThrusters vehicle(5);
  std::string said;
  Samples samples;
  Listener listener(said, samples);
  live::LearnerHealth health;
  vehicle.drive(learned, 600.0);
  reporter.update(&learned, {}, 600.0, health, listener);
  EXPECT_EQ(said, "");
  vehicle.share = {1.0, 1.0, 0.0, 0.0};
  vehicle.drive(learned, 60.0);
  reporter.update(&learned, {}, 660.0, health, listener);
  EXPECT_TRUE(said.starts_with("at 660.0 s: WARNING: NEARLY NO AUTHORITY left in sway; th"))
      << said;
  EXPECT_TRUE(said.ends_with(" m/s from ahead\n")) << said;
  EXPECT_TRUE(health.authority.starts_with("NEARLY NO AUTHORITY left in sway; ")) << said;
}

TEST_F(Live, BytesThatAreNoMessageDoNoHarm) {
  std::vector<Recorded> messages = little_mission(80.0);
  RandomStream random(5, "noise");
  std::size_t spoiled = 0;
  for (Recorded& message : messages) {
    if (message.topic == 0 && random.uniform(0.0, 1.0) < 0.05) {
      ++spoiled;
      message.data.resize(static_cast<std::size_t>(random.uniform(0.0, 40.0)));
    }
  }
  const live::Health health = run(messages);
  EXPECT_EQ(health.topics[0].undecodable, spoiled);
  expect_learned(health, 700);
}

TEST_F(Live, ATopicOfAnotherTypeIsSaid) {
  std::vector<bag::Topic> topics = testing::mission_topics();
  topics[1].type = "std_msgs/msg/Float64MultiArray";
  const live::Health health =
      run(little_mission(20.0), mission_config("clock = \"header\"", ""), topics);
  EXPECT_NE(health.topics[1].refused.find("has no field twist.linear.x"), std::string::npos)
      << health.topics[1].refused;
  EXPECT_EQ(health.learner.learned, 0U);
  EXPECT_EQ(health.sources[1].silent_s, std::numeric_limits<double>::infinity());
}

TEST_F(Live, TheFirstStampNeedNotComeFirst) {
  std::vector<Recorded> messages = little_mission(80.0);
  run(messages);
  const std::string model = testing::read_text(folder_ / "model.json");
  std::swap(messages[0], messages[1]);
  ASSERT_NE(messages[0].topic, messages[1].topic);
  run(messages);
  EXPECT_EQ(testing::read_text(folder_ / "model.json"), model);
}

// Degrees for radians, at the door where messages come in; an operator who has put that right
// begins the model anew.
TEST_F(Live, ATargetInAnotherUnitMakesTheModelDoubtfulUntilAReset) {
  const std::vector<Recorded> wrong = little_mission(150.0, 1, 0.0, 0.0174533);
  live::Health health = run(wrong, testing::imu_config("align = \"none\""), testing::imu_topics());
  health.idle_s = 0.0;  // a slow machine learns the last rows long after the last message
  EXPECT_EQ(health.learner.learned, health.rows - health.rows_incomplete);
  EXPECT_NE(health.learner.doubt.find("degrees"), std::string::npos) << health.learner.doubt;
  EXPECT_NE(said_.find("WARNING: the model is doubtful: " + health.learner.doubt),
            std::string::npos)
      << said_;
  const std::vector<live::Alert> alerts = live::alerts_of(health, health);
  ASSERT_FALSE(alerts.empty());
  EXPECT_EQ(alerts.front().level, live::AlertLevel::error);
  EXPECT_EQ(alerts.front().text, "the model is doubtful: " + health.learner.doubt);
  // After a restart, the model is the same, and so is the doubt.
  const std::vector<Recorded> right = little_mission(150.0, 2, 0.0, 1.0);
  const std::string config = testing::imu_config("align = \"none\"");
  EXPECT_FALSE(run(right, config, testing::imu_topics(), true).learner.doubt.empty());
  requests_.push(live::Request::reset);
  EXPECT_TRUE(run(right, config, testing::imu_topics(), true).learner.doubt.empty());
}

}  // namespace
}  // namespace kelpie::engine_test
