// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kelpie::dds {

/// What ROS 2 makes of its names on DDS
/// (https://design.ros2.org/articles/topic_and_service_names.html).

/// "nav_msgs::msg::dds_::Odometry_" of "nav_msgs/msg/Odometry" or "nav_msgs/Odometry".
/// Throws InputError (type) on anything else.
std::string dds_type_name(const std::string& ros_type);

/// "nav_msgs/msg/Odometry" of "nav_msgs::msg::dds_::Odometry_"; empty: no message of ROS 2.
std::string ros_type_name(std::string_view dds_type);

/// "rt/dvl/odom" of "/dvl/odom". Throws InputError (topic) unless it is a full name: a slash before
/// each part, parts of letters, digits and underscores that don't begin with a digit.
std::string dds_topic_name(const std::string& ros_topic);

/// "/dvl/odom" of "rt/dvl/odom"; empty: no topic of ROS 2 (services and actions have other
/// prefixes).
std::string ros_topic_name(std::string_view dds_topic);

/// A node's names of topics and the rules that replace them, as ROS 2 has them on its command line.
class TopicNames {
 public:
  TopicNames() = default;
  /// `name_space`: "" or "/" for none, or "/vehicle"; `node`: what "~" stands for; each of
  /// `remappings` is "from:=to". Throws InputError on what is no name or no rule.
  TopicNames(const std::string& name_space, std::string node,
             const std::vector<std::string>& remappings);

  /// The full name of a topic: "/odom" as it is, "odom" within the name space, "~/odom" within that
  /// of the node; then replaced by the first rule whose left side is the same topic.
  /// Throws InputError (topic) on what is no name.
  std::string full_name(const std::string& topic) const;

  bool operator==(const TopicNames&) const = default;

 private:
  std::string expanded(const std::string& topic) const;

  std::string name_space_;  // "" or "/vehicle"
  std::string node_ = "kelpie";
  std::vector<std::pair<std::string, std::string>> rules_;  // full names
};

}  // namespace kelpie::dds
