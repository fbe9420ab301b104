// SPDX-License-Identifier: Apache-2.0
#include "dds/names.hpp"

#include <gtest/gtest.h>

#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::names_test {
namespace {

TEST(Names, TypesAndTopicsAreThoseOfRosOnDds) {
  EXPECT_EQ(dds::dds_type_name("nav_msgs/msg/Odometry"), "nav_msgs::msg::dds_::Odometry_");
  EXPECT_EQ(dds::dds_type_name("nav_msgs/Odometry"), "nav_msgs::msg::dds_::Odometry_");
  EXPECT_EQ(dds::ros_type_name("nav_msgs::msg::dds_::Odometry_"), "nav_msgs/msg/Odometry");
  EXPECT_EQ(dds::dds_topic_name("/dvl/odom"), "rt/dvl/odom");
  EXPECT_EQ(dds::ros_topic_name("rt/dvl/odom"), "/dvl/odom");
}

TEST(Names, WhatIsOnDdsWithoutRosHasNoNameThere) {
  for (const char* const type : {"HelloWorld", "std_srvs::srv::dds_::Trigger_Request_",
                                 "a::msg::dds_::B", "::msg::dds_::B_", "a::msg::dds_::_", ""}) {
    EXPECT_EQ(dds::ros_type_name(type), "") << type;
  }
  for (const char* const topic :
       {"rq/serviceRequest", "odom", "rt", "rt/", "rtodom", "rt//odom", "rt/odom/", "rt/a b", ""}) {
    EXPECT_EQ(dds::ros_topic_name(topic), "") << topic;
  }
  EXPECT_EQ(dds::ros_type_name(std::string(20'000, 'a') + "::msg::dds_::B_"), "");
  EXPECT_EQ(dds::ros_topic_name("rt/" + std::string(20'000, 'a')), "");
}

TEST(Names, WhatIsNoNameIsRefused) {
  for (const char* const topic : {"odom", "", "/", "//odom", "/odom/", "/1st", "/a-b", "/a/~"}) {
    EXPECT_THROW(dds::dds_topic_name(topic), InputError) << topic;
  }
  for (const char* const type :
       {"Odometry", "nav_msgs/srv/Odometry", "a/msg/b/c", "a/", "/b", ""}) {
    EXPECT_THROW(dds::dds_type_name(type), InputError) << type;
  }
}

TEST(Names, TopicsAreFoundInTheNameSpaceAndReplacedByRules) {
  const dds::TopicNames names("/dagon", "learner",
                              {"odom:=/dvl/odom", "/thrusters:=rpm", "~/x:=y"});
  EXPECT_EQ(names.full_name("imu"), "/dagon/imu");
  EXPECT_EQ(names.full_name("/imu"), "/imu");
  EXPECT_EQ(names.full_name("~/prediction"), "/dagon/learner/prediction");
  EXPECT_EQ(names.full_name("odom"), "/dvl/odom");
  EXPECT_EQ(names.full_name("/dagon/odom"), "/dvl/odom");
  EXPECT_EQ(names.full_name("/odom"), "/odom");
  EXPECT_EQ(names.full_name("/thrusters"), "/dagon/rpm");
  EXPECT_EQ(names.full_name("~/x"), "/dagon/y");
  EXPECT_EQ(dds::TopicNames("/", "kelpie", {}).full_name("odom"), "/odom");
  EXPECT_EQ(dds::TopicNames("dagon", "kelpie", {}).full_name("odom"), "/dagon/odom");
  EXPECT_EQ(dds::TopicNames().full_name("~/x"), "/kelpie/x");
}

TEST(Names, ARuleThatIsNoneIsNamed) {
  EXPECT_NE(testing::message_of<InputError>([] {
              dds::TopicNames("", "k", {"odom=/x"});
            }).find("odom:=/dvl/odom"),
            std::string::npos);
  EXPECT_THROW(dds::TopicNames("", "k", {"odom:="}), InputError);
  EXPECT_THROW(dds::TopicNames("/a b", "k", {}), InputError);
  EXPECT_THROW(dds::TopicNames("", "k/l", {}), InputError);
}

}  // namespace
}  // namespace kelpie::names_test
