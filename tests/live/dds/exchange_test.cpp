// SPDX-License-Identifier: Apache-2.0
// Topics between processes: with this library's own kind, and with another vendor's.

#include <gtest/gtest.h>

#include "bag/cdr.hpp"
#include "bag/message_builder.hpp"
#include "dds/loopback.hpp"
#include "dds/peer_commands.hpp"
#include "dds/publication.hpp"
#include "dds/subscription.hpp"

namespace kelpie::exchange_test {
namespace {

using dds::Quality;
using testing::connected;
using testing::eventually;
using testing::Peer;

// The number at a path of a message, as the reader of bags sees it.
double number_at(const std::string& type_name, const std::string& path,
                 const std::vector<std::byte>& cdr) {
  class One : public bag::NumberVisitor {
   public:
    explicit One(std::size_t wanted) : leaf(wanted) {}
    bool wants(std::size_t other) const override { return other == leaf; }
    void number(std::size_t /*field*/, std::span<const std::uint32_t> /*index*/,
                double value) override {
      found = value;
    }
    std::size_t leaf;
    double found = -1.0;
  };
  const bag::MessageType type = bag::MessageDefinitions().type(type_name);
  One one(type.find(path));
  bag::visit_numbers(type, cdr, one);
  return one.found;
}

class Exchange : public ::testing::TestWithParam<const char*> {
 protected:
  dds::Participant participant{dds::Network::loopback(testing::own_domain())};
  dds::MessageQueue queue;
  dds::TopicSample message;
  Peer peer{GetParam()};

  bool next() { return testing::take(queue, message); }
};

TEST_P(Exchange, OdometryOfAPublisherIsDecodedAsFromABag) {
  for (const char* const quality : {"best_effort", "reliable"}) {
    // A topic each: nobody is taken for one who is just leaving.
    const std::string topic = std::string("/dvl/") + quality;
    const dds::Subscription odometry(participant, topic, "nav_msgs/msg/Odometry",
                                     Quality::sensor_data(), queue, 3);
    peer.order("publish " + topic + " nav_msgs/msg/Odometry " + quality);
    ASSERT_TRUE(connected(peer, odometry));
    EXPECT_TRUE(odometry.mismatches().empty());
    peer.order("odometry 1700000000 0.625");
    ASSERT_TRUE(next());
    EXPECT_EQ(message.topic, 3U);
    EXPECT_GT(message.source_ns, 0);
    EXPECT_GE(message.receive_ns, message.source_ns);
    EXPECT_LT(message.receive_ns - message.source_ns, 30'000'000'000);
    EXPECT_EQ(number_at("nav_msgs/msg/Odometry", "twist.twist.linear.x", message.cdr), 0.625);
    EXPECT_EQ(number_at("nav_msgs/msg/Odometry", "header.stamp.sec", message.cdr), 1.7e9);
  }
}

TEST_P(Exchange, AReliableSubscriptionGetsEveryMessageInOrder) {
  const dds::Subscription numbers(participant, "/numbers", "std_msgs/msg/Float64",
                                  Quality::standard(), queue, 0);
  peer.order("publish /numbers std_msgs/msg/Float64 reliable");
  ASSERT_TRUE(connected(peer, numbers));
  peer.say("stream 2000 400 20");
  for (std::uint64_t k = 0; k < 400; ++k) {
    ASSERT_TRUE(next()) << k;
    std::uint64_t number = 0;
    std::memcpy(&number, message.cdr.data() + 4, sizeof number);
    ASSERT_EQ(number, k);
  }
  EXPECT_EQ(numbers.lost(), 0U);
}

TEST_P(Exchange, AMessageOfManyPacketsComesWhole) {
  const dds::Subscription images(participant, "/image", "sensor_msgs/msg/Image",
                                 Quality::standard(), queue, 0);
  peer.order("publish /image sensor_msgs/msg/Image reliable");
  ASSERT_TRUE(connected(peer, images));
  testing::Bytes bytes(150'000);
  for (std::size_t i = 4; i < bytes.size(); ++i) {
    bytes[i] = static_cast<std::byte>(i * 7 + i / 256);
  }
  bytes[1] = std::byte{1};
  peer.order("send " + testing::hex_of(bytes));
  ASSERT_TRUE(next());
  EXPECT_EQ(message.cdr, bytes);
}

TEST_P(Exchange, ASubscriberOfBothQualitiesHearsWhatIsPublished) {
  for (const char* const quality : {"reliable", "best_effort"}) {
    const std::string topic = std::string("/numbers/") + quality;
    dds::Publication numbers(participant, topic, "std_msgs/msg/Float64");
    peer.order("subscribe " + topic + " std_msgs/msg/Float64 " + quality);
    ASSERT_TRUE(connected(peer, numbers));
    bag::MessageBuilder number(bag::MessageDefinitions().type("std_msgs/msg/Float64"));
    number.set("data", 2.5);
    EXPECT_TRUE(numbers.publish(number.bytes()));
    const std::string heard = peer.answer("got");
    EXPECT_TRUE(heard.ends_with("000100000000000000000440")) << heard;
  }
}

TEST_P(Exchange, WhatDoesNotMatchIsSaid) {
  const dds::Subscription reliable(participant, "/odom", "nav_msgs/msg/Odometry",
                                   Quality::standard(), queue, 0);
  const dds::Subscription twist(participant, "/odom", "geometry_msgs/msg/TwistStamped",
                                Quality::sensor_data(), queue, 0);
  const dds::Publication accel(participant, "/accel", "geometry_msgs/msg/AccelStamped",
                               Quality::sensor_data());
  peer.order("publish /odom nav_msgs/msg/Odometry best_effort");
  peer.order("subscribe /accel geometry_msgs/msg/AccelStamped reliable");
  ASSERT_TRUE(eventually([&] {
    return !reliable.mismatches().empty() && !twist.mismatches().empty() &&
           !accel.mismatches().empty();
  }));
  EXPECT_EQ(reliable.mismatches(),
            std::vector<std::string>{"/odom: a publisher offers best effort, while reliable is "
                                     "asked for here (reliability)"});
  EXPECT_EQ(twist.mismatches(),
            std::vector<std::string>{"/odom: a publisher has type 'nav_msgs/msg/Odometry', not "
                                     "'geometry_msgs/msg/TwistStamped'"});
  EXPECT_EQ(accel.mismatches(),
            std::vector<std::string>{"/accel: a subscriber asks for reliable, while best effort is "
                                     "offered here (reliability)"});
  EXPECT_EQ(reliable.publishers(), 0U);
}

TEST_P(Exchange, WhoIsThereIsListedUntilItIsGone) {
  const auto listed = [&](bool publishes, const std::string& topic) {
    for (const dds::Endpoint& end : participant.endpoints(topic)) {
      if (end.publishes == publishes && !end.own) {
        return end.type;
      }
    }
    return std::string();
  };
  {
    Peer guest(GetParam());
    guest.order("publish /odom nav_msgs/msg/Odometry best_effort");
    guest.order("subscribe /accel geometry_msgs/msg/Accel reliable");
    EXPECT_TRUE(eventually([&] { return listed(true, "/odom") == "nav_msgs/msg/Odometry"; }));
    EXPECT_TRUE(eventually([&] { return listed(false, "/accel") == "geometry_msgs/msg/Accel"; }));
    EXPECT_EQ(listed(true, "/accel"), "");
  }
  EXPECT_TRUE(eventually([&] { return listed(true, "/odom").empty(); }));
}

TEST_P(Exchange, AnotherPartitionIsSaidAndTheSameOneConnects) {
  Quality apart = Quality::sensor_data();
  apart.partition = "dagon";
  const dds::Subscription odometry(participant, "/odom", "nav_msgs/msg/Odometry", apart, queue, 0);
  peer.order("publish /odom nav_msgs/msg/Odometry best_effort");
  ASSERT_TRUE(eventually([&] { return !odometry.mismatches().empty(); }));
  EXPECT_EQ(odometry.mismatches().front(), "/odom: a publisher is in partition '', not 'dagon'");
  const dds::Publication same(participant, "/odom", "nav_msgs/msg/Odometry", apart);
  EXPECT_TRUE(eventually([&] { return odometry.publishers() == 1; }));
}

// Of many publishers some are told, each in a line of its own.
TEST_P(Exchange, NamesOfOthersAreToldInOneShortLine) {
  Quality apart = Quality::sensor_data();
  apart.partition = "dagon";
  const dds::Subscription odometry(participant, "/odom", "nav_msgs/msg/Odometry", apart, queue, 0);
  apart.partition = "a\nkelpie: b" + std::string(20'000, 'x');
  const dds::Publication hostile(participant, "/odom", "nav_msgs/msg/Odometry", apart);
  ASSERT_TRUE(eventually([&] { return !odometry.mismatches().empty(); }));
  EXPECT_EQ(odometry.mismatches(),
            std::vector<std::string>{"/odom: a publisher is in partition 'a?kelpie: b" +
                                     std::string(69, 'x') + "…', not 'dagon'"});
  std::vector<std::unique_ptr<dds::Publication>> many;
  for (int k = 0; k < 12; ++k) {
    apart.partition = "p" + std::to_string(k);
    many.push_back(
        std::make_unique<dds::Publication>(participant, "/odom", "nav_msgs/msg/Odometry", apart));
  }
  ASSERT_TRUE(eventually([&] { return odometry.mismatches().size() >= 8; }));
  EXPECT_EQ(odometry.mismatches().size(), 8U);
  EXPECT_TRUE(odometry.mismatches().back().ends_with("; further ones are left out"));
}

// Its process stands still, so nothing is ever acknowledged.
TEST_P(Exchange, ASubscriberThatStopsHoldsNobodyUp) {
  const testing::Bytes bytes(1'000, std::byte{1});
  dds::Publication numbers(participant, "/numbers", "std_msgs/msg/Float64");
  const dds::Subscription here(participant, "/numbers", "std_msgs/msg/Float64", Quality::standard(),
                               queue, 0);
  peer.order("subscribe /numbers std_msgs/msg/Float64 reliable");
  ASSERT_TRUE(connected(peer, numbers));
  ASSERT_TRUE(eventually([&] { return here.publishers() == 1; }));
  const std::uint64_t before = here.received();
  peer.signal(SIGSTOP);
  for (int k = 0; k < 5'000; ++k) {
    ASSERT_TRUE(numbers.publish(bytes)) << k;
  }
  EXPECT_EQ(numbers.refused(), 0U);
  EXPECT_EQ(here.received() - before, 5'000U);
}

std::vector<const char*> peers() {
  return {KELPIE_PEER_CYCLONE,
#ifdef KELPIE_PEER_FAST
          KELPIE_PEER_FAST
#endif
  };
}

INSTANTIATE_TEST_SUITE_P(With, Exchange, ::testing::ValuesIn(peers()), [](const auto& program) {
  return std::string(program.param).ends_with("fast") ? "AnotherVendor" : "ItsOwnKind";
});

#ifdef KELPIE_PEER_FAST

class OtherVendor : public Exchange {};

TEST_P(OtherVendor, ReadsOurMessagesWithItsOwnCdr) {
  dds::Publication accel(participant, "/kelpie/prediction",
                         "geometry_msgs/msg/AccelWithCovarianceStamped");
  peer.order("subscribe /kelpie/prediction geometry_msgs/msg/AccelWithCovarianceStamped reliable");
  ASSERT_TRUE(connected(peer, accel));
  bag::MessageBuilder message_built(
      bag::MessageDefinitions().type("geometry_msgs/msg/AccelWithCovarianceStamped"));
  message_built.set("header.stamp.sec", 5.0);
  message_built.set("header.stamp.nanosec", 250.0);
  message_built.set("header.frame_id", "base_link");
  message_built.set("accel.accel.linear.x", 0.5);
  message_built.set("accel.accel.angular.z", -0.25);
  message_built.set("accel.covariance[0]", 0.125);
  message_built.set("accel.covariance[35]", 4.0);
  EXPECT_TRUE(accel.publish(message_built.bytes()));
  EXPECT_EQ(peer.answer("accel"),
            "5.250 base_link 0.500000 0.000000 0.000000 0.000000 0.000000 -0.250000 0.125000 "
            "4.000000");
}

TEST_P(OtherVendor, ReadsOurDiagnosticsWithItsOwnCdr) {
  dds::Publication diagnostics(participant, "/diagnostics", "diagnostic_msgs/msg/DiagnosticArray");
  peer.order("subscribe /diagnostics diagnostic_msgs/msg/DiagnosticArray reliable");
  ASSERT_TRUE(connected(peer, diagnostics));
  bag::MessageBuilder built(bag::MessageDefinitions().type("diagnostic_msgs/msg/DiagnosticArray"));
  built.set("header.stamp.sec", 9.0);
  built.set("status[0].name", "kelpie");
  built.set("status[0].message", "learning");
  built.set("status[0].values[0].key", "lag");
  built.set("status[0].values[0].value", "2 ms");
  built.set("status[1].level", 1.0);
  built.set("status[1].name", "/odom");
  built.set("status[1].message", "late");
  EXPECT_TRUE(diagnostics.publish(built.bytes()));
  EXPECT_EQ(peer.answer("diagnostics"), "9.0  [0 kelpie: learning, lag=2 ms] [1 /odom: late]");
}

INSTANTIATE_TEST_SUITE_P(With, OtherVendor, ::testing::Values(KELPIE_PEER_FAST),
                         [](const auto&) { return "FastDds"; });

#endif

}  // namespace
}  // namespace kelpie::exchange_test
