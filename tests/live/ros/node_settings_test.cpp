// SPDX-License-Identifier: Apache-2.0
#include "ros/node_settings.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::node_settings_test {
namespace {

class NodeSettings : public ::testing::Test {
 protected:
  ros::NodeSettings read(const std::string& lines) const {
    testing::write_text(folder_ / "x.toml", "[live.dds]\n" + lines + "\n");
    return ros::read_node_settings(file::TomlNode::read(folder_ / "x.toml")["live"]["dds"]);
  }
  std::string refusal(const std::string& lines) const {
    const std::string text = testing::message_of<InputError>([&] { read(lines); });
    const std::string file = (folder_ / "x.toml").string();
    return text.starts_with(file) ? text.substr(file.size()) : text;
  }

  testing::TemporaryFolder folder_;
};

TEST_F(NodeSettings, LoopbackIsOneLine) {
  EXPECT_EQ(read("domain = 7\nloopback = true").network, dds::Network::loopback(7));
  EXPECT_EQ(refusal("loopback = true\npeers = [\"10.0.0.2\"]"),
            ":3: live.dds.peers: says nothing where loopback = true");
}

TEST_F(NodeSettings, AllOfANodesPlaceIsSet) {
  const ros::NodeSettings settings = read(
      "domain = 3\ninterface = \"lo\"\npeers = [\"10.0.0.2\", \"dagon.local\"]\n"
      "multicast = false\npartition = \"dagon\"\nnamespace = \"auv\"\nnode = \"model\"\n"
      "remap = [\"/odom:=/dvl/odom\"]\nreliable = true\nframe = \"com\"");
  EXPECT_EQ(settings.network.domain, 3U);
  EXPECT_EQ(settings.network.interface, "lo");
  EXPECT_EQ(settings.network.peers, (std::vector<std::string>{"10.0.0.2", "dagon.local"}));
  EXPECT_FALSE(settings.network.multicast);
  EXPECT_EQ(settings.subscribed.partition, "dagon");
  EXPECT_EQ(settings.published.partition, "dagon");
  EXPECT_TRUE(settings.subscribed.reliable);
  EXPECT_EQ(settings.frame, "com");
  EXPECT_EQ(settings.names.full_name("~/prediction"), "/auv/model/prediction");
  EXPECT_EQ(settings.names.full_name("/odom"), "/dvl/odom");
}

TEST_F(NodeSettings, WhatIsWrongIsNamedWithLineAndKey) {
  EXPECT_EQ(refusal("domain = 233"), ":2: live.dds.domain: is out of range; it has to be 0 to 232");
  EXPECT_EQ(refusal("loopback = 1"), ":2: live.dds.loopback: has to be true or false");
  EXPECT_NE(refusal("interface = \"l0\"")
                .find(":2: live.dds.interface: 'l0' is no interface of "
                      "this machine"),
            std::string::npos);
  EXPECT_NE(refusal("\npeers = [\"<x>\"]").find(":3: live.dds.peers: "), std::string::npos);
  EXPECT_NE(refusal("node = \"2nd\"").find(":2: live.dds.node: "), std::string::npos);
  EXPECT_NE(refusal("namespace = \"a b\"").find(":2: live.dds.namespace: "), std::string::npos);
  EXPECT_NE(refusal("remap = [\"a=b\"]").find(":2: live.dds.remap: "), std::string::npos);
  EXPECT_EQ(refusal("configuration = \"no.xml\""),
            ":2: live.dds.configuration: 'no.xml' is no file");
  EXPECT_NE(refusal("domian = 1").find("did you mean 'domain'"), std::string::npos);
}

// NOLINTBEGIN(concurrency-mt-unsafe): no other thread runs
TEST_F(NodeSettings, TheEnvironmentCountsWhereTheFileSaysNothing) {
  ::setenv("ROS_DOMAIN_ID", "42", 1);
  ::setenv("CYCLONEDDS_URI", "<CycloneDDS/>", 1);
  const ros::NodeSettings none = ros::read_node_settings(std::nullopt);
  const ros::NodeSettings some = read("loopback = true");
  testing::write_text(folder_ / "dds.xml", "<CycloneDDS></CycloneDDS>");
  const ros::NodeSettings all = read("domain = 5\nconfiguration = \"dds.xml\"");
  ::setenv("ROS_DOMAIN_ID", "x", 1);
  EXPECT_NE(testing::message_of<InputError>([] {
              ros::read_node_settings(std::nullopt);
            }).find("ROS_DOMAIN_ID"),
            std::string::npos);
  ::unsetenv("ROS_DOMAIN_ID");
  ::unsetenv("CYCLONEDDS_URI");
  EXPECT_EQ(none.network.domain, 42U);
  EXPECT_EQ(none.network.configuration, "<CycloneDDS/>");
  EXPECT_EQ(some.network.domain, 42U);
  EXPECT_EQ(some.network.configuration, "<CycloneDDS/>");
  EXPECT_EQ(all.network.domain, 5U);
  EXPECT_EQ(all.network.configuration, "file://" + (folder_ / "dds.xml").string());
}
// NOLINTEND(concurrency-mt-unsafe)

}  // namespace
}  // namespace kelpie::node_settings_test
