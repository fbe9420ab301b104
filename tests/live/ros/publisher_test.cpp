// SPDX-License-Identifier: Apache-2.0
// Velocities and authority as topics, heard by a subscriber.
#include "ros/publisher.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bag/topic_columns.hpp"
#include "dds/loopback.hpp"
#include "live/requests.hpp"
#include "ros/topic_transport.hpp"
#include "support.hpp"
#include "vehicle/four_thrusters.hpp"

namespace kelpie::publisher_test {
namespace {

constexpr const char* kConfig =
    "[log]\ninputs = [\"u\", \"v\", \"r\", \"n\"]\ntargets = [\"udot\", \"vdot\", "
    "\"rdot\"]\nrate = 10\n[log.states]\nu = \"/odom:twist.twist.linear.x\"\n"
    "v = \"/odom:twist.twist.linear.y\"\nr = \"/odom:twist.twist.angular.z\"\n"
    "[log.commands]\nn = \"/thrust:wrench.force.x\"\n[log.derived]\nudot = \"d(u)\"\n"
    "vdot = \"d(v)\"\nrdot = \"d(r)\"\n";

DeadReckoning at_speed() {
  OpenLoop loop;
  loop.accelerations = [](std::span<const double> /*x*/, std::span<double> a) {
    std::ranges::fill(a, 0.0);
  };
  loop.states = {0, 1, 2};
  loop.error = {0.01, 0.01, 0.01};
  loop.error_time_s = {1.0, 1.0, 1.0};
  loop.noise = {0.02, 0.03, 0.01};
  loop.seen = {{-1.0, 1.0}, {-1.0, 1.0}, {-1.0, 1.0}, {-1.0, 1.0}};
  DeadReckoning reckoning(loop);
  reckoning.update(std::array{0.4, 0.1, -0.2, 0.0}, 0.0);
  return reckoning;
}

TEST(Publisher, TellsVelocitiesWithTheirCovariance) {
  const testing::TemporaryFolder folder;
  testing::write_text(folder / "x.toml", kConfig);
  const live::Configuration configuration = live::read_configuration(folder / "x.toml", {});
  const dds::Participant participant(dds::Network::loopback(testing::own_domain()));
  ros::Publisher publisher(participant, {}, configuration);
  dds::MessageQueue queue;
  const std::string type = "geometry_msgs/msg/TwistWithCovarianceStamped";
  const dds::Subscription subscription(participant, "/kelpie/velocity", type,
                                       dds::Quality::standard(), queue, 0);
  ASSERT_TRUE(testing::eventually([&] { return subscription.publishers() > 0; }));

  const std::vector<std::string> names{"u", "v", "r"};
  const DeadReckoning reckoning = at_speed();
  dds::TopicSample message;
  ASSERT_TRUE(testing::eventually([&] {
    publisher.reckoned({.stamp_ns = 0,
                        .data_ns = 1'700'000'000'250'000'000,
                        .names = names,
                        .reckoning = reckoning});
    return queue.pop(message, std::chrono::milliseconds(50));
  }));
  bag::TopicColumns columns("/kelpie/velocity");
  for (const char* const field :
       {"header.stamp.sec", "header.stamp.nanosec", "twist.twist.linear.x", "twist.twist.linear.y",
        "twist.twist.angular.z", "twist.covariance[0]", "twist.covariance[7]",
        "twist.covariance[14]", "twist.covariance[35]"}) {
    columns.ask(bag::parse_column(std::string("/kelpie/velocity:") + field));
  }
  columns.bind({.name = "/kelpie/velocity", .type = type}, bag::MessageDefinitions(),
               bag::Clock::receive);
  columns.begin({.data = message.cdr});
  columns.decoder().visit(message.cdr, columns);
  const std::array wanted{1.7e9, 2.5e8, 0.4, 0.1, -0.2, 4e-4, 9e-4, -1.0, 1e-4};
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_NEAR(columns.values()[i], wanted[i], 1e-12) << columns.columns()[i].name;
  }
  EXPECT_EQ(publisher.allocate(std::array<double, 6>{}), "what the thrusters do isn't known yet");
}

// A table of numbers: a std_msgs/Float64MultiArray of two dimensions, in plain CDR.
struct Table {
  std::array<std::string, 2> labels{};  // of rows and of columns
  std::array<std::uint32_t, 2> sizes{};
  std::array<std::uint32_t, 2> strides{};
  std::vector<double> data{};

  explicit Table(const testing::Bytes& cdr) : body_(cdr.begin() + 4, cdr.end()) {
    EXPECT_EQ(count(), 2U);
    for (std::size_t dimension = 0; dimension < 2; ++dimension) {
      const std::uint32_t length = count();
      const auto text = std::span(body_).subspan(at_, length - 1);
      labels[dimension].assign(reinterpret_cast<const char*>(text.data()), text.size());
      at_ += length;
      sizes[dimension] = count();
      strides[dimension] = count();
    }
    count();  // the offset of the data
    data.resize(count());
    at_ = (at_ + 7) / 8 * 8;
    const auto numbers = std::span(body_).subspan(at_, data.size() * sizeof(double));
    std::memcpy(data.data(), numbers.data(), numbers.size());
  }

  double at(std::size_t row, std::size_t column) const {
    return data.at(row * strides[1] + column);
  }

 private:
  std::uint32_t count() {
    at_ = (at_ + 3) / 4 * 4;
    std::uint32_t value = 0;
    std::memcpy(&value, std::span(body_).subspan(at_, sizeof(value)).data(), sizeof(value));
    at_ += sizeof(value);
    return value;
  }

  testing::Bytes body_;
  std::size_t at_ = 0;
};

// A vehicle whose first thruster has lost half of its thrust, at the topics of a live run.
class Thrusters : public ::testing::Test {
 protected:
  using Vehicle = testing::FourThrusters;

  Thrusters() {
    testing::write_text(
        folder_ / "x.toml",
        "[log]\ninputs = [\"u\", \"v\", \"r\", \"th1\", \"th2\", \"th3\", \"th4\"]\n"
        "targets = [\"udot\", \"vdot\", \"rdot\"]\nrate = 4\n[log.states]\n"
        "u = \"/odom:twist.twist.linear.x\"\nv = \"/odom:twist.twist.linear.y\"\n"
        "r = \"/odom:twist.twist.angular.z\"\n[log.commands]\n"
        "th1 = \"/thrust:data[0]\"\nth2 = \"/thrust:data[1]\"\n"
        "th3 = \"/thrust:data[2]\"\nth4 = \"/thrust:data[3]\"\n[log.derived]\n"
        "udot = \"d(u)\"\nvdot = \"d(v)\"\nrdot = \"d(r)\"\n");
    configuration_ = live::read_configuration(folder_ / "x.toml", {});
    ros::NodeSettings settings;
    settings.network = dds::Network::loopback(testing::own_domain());
    transport_ = std::make_unique<ros::TopicTransport>(configuration_, settings);
    output_ = transport_->open_output(requests_);
    node_.order("publish /kelpie/wanted geometry_msgs/msg/AccelStamped reliable");
  }

  void know_thrusters(const Alignment& alignment) {
    Diagnosis learned = Vehicle::diagnosis();
    vehicle_.drive(learned, 600.0);
    vehicle_.share = {0.5, 1.0, 1.0, 1.0};
    vehicle_.drive(learned, 60.0);
    health_.learner.effectiveness = std::make_shared<const live::Effectiveness>(
        live::Effectiveness{Authority(learned, Vehicle::ranges()), alignment});
    output_->health(health_);
  }

  // What a node hears of a topic while `act` is done again and again: before they know each other,
  // nothing comes of it.
  Table heard(const std::string& topic, const std::function<void()>& act) {
    node_.order("subscribe " + topic + " std_msgs/msg/Float64MultiArray reliable");
    std::optional<std::string> message;
    EXPECT_TRUE(testing::eventually([&] {
      act();
      pump();
      message = node_.said("got");
      return message.has_value();
    }));
    return Table(testing::bytes_of_hex(message.value()));
  }

  // The answer to wanted accelerations, along and about the axes of a twist.
  Table allocated(const std::array<double, 6>& wanted) {
    return heard("/kelpie/allocation", [&] { want(wanted); });
  }
  void want(const std::array<double, 6>& wanted) {
    constexpr std::array<const char*, 6> kFields{"linear.x",  "linear.y",  "linear.z",
                                                 "angular.x", "angular.y", "angular.z"};
    bag::MessageBuilder message(bag::MessageDefinitions().type("geometry_msgs/msg/AccelStamped"));
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      message.set(std::string("accel.") + kFields[i], wanted[i]);
    }
    const std::span<const std::byte> bytes = message.bytes();
    node_.say("send " + testing::hex_of({bytes.begin(), bytes.end()}));
  }
  void pump() {
    bag::Message message;
    transport_->next(message, std::chrono::milliseconds(5));
  }

  // What the vehicle makes of such efforts.
  std::array<double, 3> accelerations(const std::vector<double>& efforts) const {
    std::array<double, 3> sum{};
    for (std::size_t i = 0; i < sum.size(); ++i) {
      for (std::size_t k = 0; k < efforts.size(); ++k) {
        sum[i] += vehicle_.share[k] * Vehicle::kThrust[i][k] * efforts[k] * std::abs(efforts[k]);
      }
    }
    return sum;
  }
  void expect_accelerations(const std::vector<double>& efforts,
                            const std::array<double, 3>& wanted) const {
    const std::array<double, 3> given = accelerations(efforts);
    for (std::size_t i = 0; i < given.size(); ++i) {
      EXPECT_NEAR(given[i], wanted[i], 0.02) << Vehicle::kTargets[i];
    }
  }

  testing::TemporaryFolder folder_;
  live::Configuration configuration_;
  live::Requests requests_;
  std::unique_ptr<ros::TopicTransport> transport_;
  live::Output* output_ = nullptr;
  testing::Peer node_{KELPIE_PEER_CYCLONE};
  Vehicle vehicle_{3};
  live::Health health_;
};

TEST_F(Thrusters, EachHasItsRowOfWhatItDoesToEachAxis) {
  know_thrusters({});
  const Table table = heard("/kelpie/authority", [&] { output_->health(health_); });
  EXPECT_EQ(table.labels[0], "th1;th2;th3;th4");
  EXPECT_EQ(table.labels[1],
            "share;udot ahead;udot ahead ±;udot astern;udot astern ±;vdot ahead;vdot ahead ±;"
            "vdot astern;vdot astern ±;rdot ahead;rdot ahead ±;rdot astern;rdot astern ±");
  EXPECT_EQ(table.sizes, (std::array<std::uint32_t, 2>{4, 13}));
  EXPECT_EQ(table.strides, (std::array<std::uint32_t, 2>{4 * 13, 13}));
  const std::vector<ThrusterEffect>& known = health_.learner.effectiveness->authority.thrusters();
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(table.at(k, 0), vehicle_.share[k], 0.06) << k;
    for (std::size_t i = 0; i < 3; ++i) {
      const double full = 16.0 * vehicle_.share[k] * Vehicle::kThrust[i][k];
      EXPECT_NEAR(table.at(k, 4 * i + 1), full, 0.03) << k << i;
      EXPECT_NEAR(table.at(k, 4 * i + 3), -full, 0.03) << k << i;
      EXPECT_EQ(table.at(k, 4 * i + 2), known[k].ahead_width[i]) << k << i;
      EXPECT_EQ(table.at(k, 4 * i + 4), known[k].astern_width[i]) << k << i;
      EXPECT_NE(known[k].ahead_width[i], known[k].astern_width[i]) << k << i;
    }
  }
}

TEST_F(Thrusters, AreGivenCommandsForWantedAccelerations) {
  constexpr std::array<double, 6> wanted{0.2, -0.3, 9.0, 9.0, 9.0, 0.1};
  EXPECT_TRUE(testing::eventually([&] {
    want(wanted);
    pump();
    const std::vector<std::string> faults = transport_->health().faults;
    return std::ranges::count(faults, "/kelpie/wanted: what the thrusters do isn't known yet") > 0;
  }));
  know_thrusters({});
  const Table table = allocated(wanted);
  EXPECT_EQ(table.labels[0], "command");
  EXPECT_EQ(table.labels[1], "th1;th2;th3;th4");
  EXPECT_EQ(table.sizes, (std::array<std::uint32_t, 2>{1, 4}));
  expect_accelerations(table.data, {0.2, -0.3, 0.1});
}

// The vehicle's efforts are pulses to a driver: at rest 1500 µs, for th3 1450 µs, with a dead band
// and less thrust astern.
TEST_F(Thrusters, AreGivenThePulsesOfTheirActuators) {
  Alignment pulses{.commands = {"th1", "th2", "th3", "th4"}};
  pulses.actuators.assign(4, {.neutral = 1500.0});
  pulses.actuators[2] = {.neutral = 1450.0, .dead_band = 3.0, .astern = 0.5};
  know_thrusters(pulses);
  std::vector<double> efforts = allocated({0.1, -0.3, 0.0, 0.0, 0.0, 0.0}).data;
  ASSERT_EQ(efforts.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(efforts[k], pulses.actuators[k].neutral, 15.0);
    efforts[k] = pulses.actuators[k].shaped(efforts[k]);
  }
  expect_accelerations(efforts, {0.1, -0.3, 0.0});
}

TEST_F(Thrusters, HoldAnAxisOfWhichNothingIsWanted) {
  know_thrusters({});
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  expect_accelerations(allocated({nothing, 0.2, nothing, nothing, nothing, nothing}).data,
                       {0.0, 0.2, 0.0});
}

}  // namespace
}  // namespace kelpie::publisher_test
