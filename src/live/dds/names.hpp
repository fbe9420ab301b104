// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kelpie::dds {

/// Names of ROS 2 on DDS
/// (https://design.ros2.org/articles/topic_and_service_names.html).

/// "nav_msgs::msg::dds_::Odometry_" of "nav_msgs/msg/Odometry" or "nav_msgs/Odometry".
/// Throws InputError (type) on other names.
std::string dds_type_name(const std::string& ros_type);

/// "nav_msgs/msg/Odometry" of "nav_msgs::msg::dds_::Odometry_"; empty on other names.
std::string ros_type_name(std::string_view dds_type);

/// "rt/dvl/odom" of "/dvl/odom". Throws InputError (topic) unless each part of the name has a
/// leading slash, letters, digits and underscores, and starts without a digit.
std::string dds_topic_name(const std::string& ros_topic);

/// "/dvl/odom" of "rt/dvl/odom"; empty on other names (services and actions have other prefixes).
std::string ros_topic_name(std::string_view dds_topic);

/// Names of a node's topics, with remappings as on ROS 2's command line.
class TopicNames {
 public:
  TopicNames() = default;
  /// `name_space` is "", "/" or "/vehicle"; `node` stands for "~"; each of `remappings` is
  /// "from:=to". Throws InputError on invalid names and rules.
  TopicNames(const std::string& name_space, std::string node,
             const std::vector<std::string>& remappings);

  /// Full name of a topic: "/odom" unchanged, "odom" in the name space, "~/odom" in the node's;
  /// then replaced by the first rule for this topic. Throws InputError (topic) on an invalid name.
  std::string full_name(const std::string& topic) const;

  bool operator==(const TopicNames&) const = default;

 private:
  std::string expanded(const std::string& topic) const;

  std::string name_space_;  // "" or "/vehicle"
  std::string node_ = "kelpie";
  std::vector<std::pair<std::string, std::string>> rules_;  // full names
};

}  // namespace kelpie::dds
