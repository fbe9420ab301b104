// SPDX-License-Identifier: Apache-2.0
#include "log/draft.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "log/candidates.hpp"
#include "log/dataset.hpp"
#include "log/pose_check.hpp"

namespace kelpie::log {
namespace {

// A table whose columns have the usual names needs no sampling: its rows are samples.
std::optional<Draft> draft_of_ready(const Table& table, const Roles& given) {
  Draft draft;
  try {
    const Roles found = guess_roles(
        table, {.time = given.time, .rate_hz = given.rate_hz, .ignored = given.ignored});
    draft.config.roles = {.inputs = found.inputs,
                          .targets = found.targets,
                          .time = found.time,
                          .rate_hz = found.rate_hz};
  } catch (const InputError&) {
    return std::nullopt;
  }
  draft.whys["rate"] = "as given";
  draft.taken = {"inputs and targets by their names: a target is udot, u_dot or du beside u"};
  if (draft.config.roles.time.empty() && draft.config.roles.rate_hz == 0.0) {
    draft.open.emplace_back(
        "rate: no column is named t, time or stamp; write rate = rows per second");
  }
  return draft;
}

// "the fields that change are a, b, c and 20 more"; "" without any.
std::string fields_text(const std::vector<Draft::Line>& fields) {
  constexpr std::size_t kShown = 30;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < std::min(fields.size(), kShown); ++i) {
    names.push_back(fields[i].from);
  }
  const std::size_t more = fields.size() - names.size();
  return names.empty() ? ""
                       : "the fields that change are " + join_text(names, ", ") +
                             (more > 0 ? " and " + std::to_string(more) + " more" : "");
}

// What is missing may be in topics that nobody can read: "/a, /b: pkg/Type: its definition …".
std::vector<std::string> undecoded(const bag::BagReport& report) {
  std::map<std::string, std::string> topics;  // by reason
  for (const bag::TopicReport& topic : report.topics) {
    if (!topic.not_decoded.empty()) {
      std::string& names = topics[topic.not_decoded];
      names += (names.empty() ? "" : ", ") + topic.name;
    }
  }
  std::vector<std::string> lines;
  for (const auto& [reason, names] : topics) {
    lines.push_back(names + " cannot be read: " + reason);
  }
  return lines;
}

// Topics of odometry whose twist lies along the axes of the world, as gazebo's p3d gives it.
std::set<std::string> topics_of_world(const bag::BagReport& report, const LogSource& source) {
  std::set<std::string> topics;
  for (const bag::TopicReport& topic : report.topics) {
    try {
      if (short_type(topic.type) == "nav_msgs/Odometry" && topic.not_decoded.empty() &&
          topic.messages > 0 && !source.path.empty() && is_twist_of_world(source, topic.name)) {
        topics.insert(topic.name);
      }
    } catch (const std::exception&) {  // whoever reads the topic says what is wrong with it
      continue;
    }
  }
  return topics;
}

// Poses, and the columns beside them, are columns of numbers; each part of a pose is named once.
void check_given(const Table& table, const Roles& given) {
  std::set<std::string> parts;
  for (const std::string& text : given.pose) {
    const auto [part, column] = pose_part(text);
    table.require_numbers(table.find(column));
    if (part.empty()) {
      throw InputError({.file = table.source, .field = text},
                       "names no part of a pose; write x=" + column +
                           ", or y, z, roll, pitch, yaw, qw, qx, qy, qz");
    }
    if (!parts.insert(part).second) {
      throw InputError({.file = table.source, .field = text}, "names " + part + " a second time");
    }
  }
  for (const std::string& name : given.pose.empty() ? std::vector<std::string>{} : given.inputs) {
    if (std::ranges::count(StreamPlan::Pose::kVelocities, name) == 0) {
      table.require_numbers(table.find(name));
    }
  }
}

}  // namespace

std::string Draft::unclear(const std::string& more) const {
  std::vector<std::string> lines = open;
  for (const std::string& line : {more, fields_text(others)}) {
    if (!line.empty()) {
      lines.push_back(line);
    }
  }
  return "the signals to use are unclear:\n  - " + join_text(lines, "\n  - ") +
         "\n`kelpie inspect " + config.source +
         " --template vehicle.toml` writes what was found; complete it, and give it by --config";
}

std::string Draft::summary() const {
  std::string text = config.source + ": no configuration; taken by types and names:\n";
  for (const std::string& line : taken) {
    text += "  " + line + "\n";
  }
  for (const std::string& line : remarks) {
    text += "  ! " + line + "\n";
  }
  return text + "to look at it and change it: kelpie inspect " + config.source +
         " --template vehicle.toml\n";
}

Draft draft_of(const bag::BagReport& report, const LogSource& source) {
  Draft draft = plan_draft(report, {}, topics_of_world(report, source));
  if (!draft.open.empty()) {
    const std::vector<std::string> lines = undecoded(report);
    draft.open.insert(draft.open.end(), lines.begin(), lines.end());
  }
  draft.config.source = source.path;
  if (!source.definitions.empty()) {
    draft.config.messages = std::filesystem::absolute(source.definitions).lexically_normal();
  }
  return draft;
}

Draft draft_of(const Table& table, const Roles& given) {
  check_given(table, given);
  std::optional<Draft> draft = given.pose.empty() ? draft_of_ready(table, given) : std::nullopt;
  if (!draft) {
    const RowClock clock = row_clock(table, given);
    draft = plan_draft(inspect_table(table, clock), clock, {}, given);
  }
  draft->config.source = table.source;
  return *std::move(draft);
}

}  // namespace kelpie::log
