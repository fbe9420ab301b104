// SPDX-License-Identifier: Apache-2.0
// Velocities and authority as topics, heard by a subscriber.
#include "ros/publisher.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "bag/topic_columns.hpp"
#include "dds/loopback.hpp"
#include "support.hpp"

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

}  // namespace
}  // namespace kelpie::publisher_test
