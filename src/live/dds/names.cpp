// SPDX-License-Identifier: Apache-2.0
#include "dds/names.hpp"

#include <algorithm>

#include "core/text.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::dds {
namespace {

constexpr std::string_view kTopicPrefix = "rt";
constexpr std::string_view kTypeInfix = "::msg::dds_::";
constexpr std::size_t kLongestName = 255;  // of ROS 2

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

bool is_word(std::string_view word) {
  return !word.empty() && is_letter(word.front()) &&
         std::ranges::all_of(word, [](char c) { return is_letter(c) || (c >= '0' && c <= '9'); });
}

// "/a/b": one word after each slash.
bool is_full_name(std::string_view name) {
  while (name.starts_with('/')) {
    const std::size_t end = std::min(name.find('/', 1), name.size());
    if (!is_word(name.substr(1, end - 1))) {
      return false;
    }
    name.remove_prefix(end);
    if (name.empty()) {
      return true;
    }
  }
  return false;
}

void require_full_name(const std::string& name, const std::string& given) {
  require(is_full_name(name), given,
          "is no name of a topic: letters, digits and underscores, with single slashes between the "
          "parts, none of which begins with a digit; one reads as /dvl/odom");
}

}  // namespace

std::string dds_type_name(const std::string& ros_type) {
  const std::vector<std::string> parts = split_text(ros_type, '/');
  const bool has_folder = parts.size() == 3 && parts[1] == "msg";
  require((parts.size() == 2 || has_folder) && is_word(parts.front()) && is_word(parts.back()),
          ros_type, "is not the name of a message type; one reads as nav_msgs/msg/Odometry");
  return parts.front() + std::string(kTypeInfix) + parts.back() + "_";
}

std::string ros_type_name(std::string_view dds_type) {
  const std::size_t infix = dds_type.find(kTypeInfix);
  if (infix == std::string_view::npos || !dds_type.ends_with('_') ||
      dds_type.size() > kLongestName) {
    return {};
  }
  const std::string_view package = dds_type.substr(0, infix);
  std::string_view name = dds_type.substr(infix + kTypeInfix.size());
  name.remove_suffix(1);
  return is_word(package) && is_word(name) ? std::string(package) + "/msg/" + std::string(name)
                                           : std::string();
}

std::string dds_topic_name(const std::string& ros_topic) {
  require_full_name(ros_topic, ros_topic);
  return std::string(kTopicPrefix) + ros_topic;
}

std::string ros_topic_name(std::string_view dds_topic) {
  if (!dds_topic.starts_with(kTopicPrefix) || dds_topic.size() > kLongestName) {
    return {};
  }
  dds_topic.remove_prefix(kTopicPrefix.size());
  return is_full_name(dds_topic) ? std::string(dds_topic) : std::string();
}

TopicNames::TopicNames(const std::string& name_space, std::string node,
                       const std::vector<std::string>& remappings)
    : node_(std::move(node)) {
  if (!name_space.empty() && name_space != "/") {
    name_space_ = name_space.starts_with('/') ? name_space : "/" + name_space;
    require_full_name(name_space_, name_space);
  }
  require(is_word(node_), node_,
          "is no name of a node: letters, digits and underscores, no digit first");
  for (const std::string& rule : remappings) {
    const std::size_t arrow = rule.find(":=");
    require(arrow != std::string::npos, rule, "is no remapping; one reads as odom:=/dvl/odom");
    rules_.emplace_back(expanded(rule.substr(0, arrow)), expanded(rule.substr(arrow + 2)));
  }
}

std::string TopicNames::full_name(const std::string& topic) const {
  const std::string name = expanded(topic);
  const auto rule = std::ranges::find(rules_, name, &std::pair<std::string, std::string>::first);
  return rule == rules_.end() ? name : rule->second;
}

std::string TopicNames::expanded(const std::string& topic) const {
  std::string name = topic;
  if (topic.starts_with("~/")) {
    name = name_space_ + "/" + node_ + topic.substr(1);
  } else if (!topic.starts_with('/')) {
    name = name_space_ + "/" + topic;
  }
  require_full_name(name, topic);
  return name;
}

}  // namespace kelpie::dds
