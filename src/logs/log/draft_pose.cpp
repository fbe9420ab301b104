// SPDX-License-Identifier: Apache-2.0
#include "log/draft_pose.hpp"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

namespace kelpie::log {
namespace {

// The parts of a pose that one topic, or a table, has by name.
PoseColumns pose_of(const bag::TopicReport& topic) {
  PoseColumns parts;
  const auto is_plain = [](const std::string& name) {
    return can_be_written(name) && name.find_first_of("\"\\") == std::string::npos;
  };
  for (const bag::FieldRange& field : topic.fields) {
    const bool is_one =
        field.finite > 0 && field.elements.empty() && is_plain(field.path) && is_plain(topic.name);
    const auto part = is_one ? measured_pose_part(field.path) : std::nullopt;
    if (part) {
      parts.try_emplace(*part, column_of(topic, field));
    }
  }
  const bool is_quaternion =
      parts.contains("qw") && parts.contains("qx") && parts.contains("qy") && parts.contains("qz");
  std::erase_if(parts, [&](const auto& part) {
    const bool is_angle = part.first.size() > 1 && part.first[0] != 'q';
    return is_quaternion ? is_angle : part.first[0] == 'q';
  });
  const bool has_plane =
      parts.contains("x") && parts.contains("y") && (is_quaternion || parts.contains("yaw"));
  if (!has_plane) {
    parts.erase("x");
    parts.erase("y");
  }
  const bool moves = std::ranges::any_of(parts, [](const auto& part) {
    return part.second.varies() && part.first != "roll" && part.first != "pitch";
  });
  return moves ? parts : PoseColumns{};
}

}  // namespace

std::pair<std::string, std::string> pose_part(const std::string& text) {
  const std::size_t sign = text.find('=');
  return {pose_part_by_name(text.substr(0, sign)).value_or(""),
          sign == std::string::npos ? text : text.substr(sign + 1)};
}

PoseChoice choose_pose(const bag::BagReport& report) {
  PoseChoice choice;
  for (const bag::TopicReport& topic : report.topics) {
    PoseColumns parts = pose_of(topic);
    if (parts.size() > choice.parts.size()) {
      choice = {std::move(parts), {topic.name}};
    } else if (!parts.empty() && parts.size() == choice.parts.size()) {
      choice.rivals.push_back(topic.name);
    }
  }
  return choice;
}

}  // namespace kelpie::log
