// SPDX-License-Identifier: Apache-2.0
#include "log/draft.hpp"

#include <map>
#include <optional>
#include <set>
#include <vector>

#include "core/text.hpp"
#include "file/toml.hpp"
#include "kelpie/core/error.hpp"
#include "log/dataset.hpp"
#include "log/draft_plan.hpp"
#include "log/pose_check.hpp"

namespace kelpie::log {
namespace {

// A table whose columns have the usual names needs no sampling: its rows are samples.
std::optional<DraftPlan> plan_of_ready(const Table& table, const Roles& given) {
  Roles roles;
  try {
    roles = guess_roles(table, {.time = given.time, .rate_hz = given.rate_hz});
  } catch (const InputError&) {
    return std::nullopt;
  }
  DraftPlan plan;
  plan.inputs = roles.inputs;
  plan.targets = roles.targets;
  plan.time = roles.time;
  plan.rate_hz = roles.rate_hz;
  plan.rate_why = "as given";
  plan.taken = {"inputs and targets by their names: a target is udot, u_dot or du beside u"};
  if (plan.time.empty() && plan.rate_hz == 0.0) {
    plan.open.emplace_back(
        "rate: no column is named t, time or stamp; write rate = rows per second");
  }
  return plan;
}

// "the fields that change are a, b, c and 20 more"; "" without any.
std::string fields_text(const std::vector<DraftPlan::Line>& fields) {
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

Draft written(const DraftPlan& plan, const std::string& log, const std::string& definitions) {
  return {.toml = draft_text(plan, log, definitions),
          .taken = plan.taken,
          .remarks = plan.remarks,
          .open = plan.open,
          .fields = plan.open.empty() ? "" : fields_text(plan.others),
          .has_targets = !plan.targets.empty()};
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

}  // namespace

LogConfig Draft::config(const std::string& source) const {
  return read_log_config(file::TomlNode::parse(toml, "the draft for " + source));
}

std::string Draft::unclear(const std::string& source, const std::string& more) const {
  std::vector<std::string> lines = open;
  for (const std::string& line : {more, fields}) {
    if (!line.empty()) {
      lines.push_back(line);
    }
  }
  return "the signals to use are unclear:\n  - " + join_text(lines, "\n  - ") +
         "\n`kelpie inspect " + source +
         " --template vehicle.toml` writes what was found; complete it, and give it by --config";
}

std::string Draft::summary(const std::string& source) const {
  std::string text = source + ": no configuration; taken by types and names:\n";
  for (const std::string& line : taken) {
    text += "  " + line + "\n";
  }
  for (const std::string& line : remarks) {
    text += "  ! " + line + "\n";
  }
  return text + "to look at it and change it: kelpie inspect " + source +
         " --template vehicle.toml\n";
}

Draft draft_of(const bag::BagReport& report, const LogSource& source) {
  DraftPlan plan = plan_draft(report, {}, topics_of_world(report, source));
  if (!plan.open.empty()) {
    const std::vector<std::string> lines = undecoded(report);
    plan.open.insert(plan.open.end(), lines.begin(), lines.end());
  }
  return written(plan, source.path, source.definitions);
}

Draft draft_of(const Table& table, const Roles& given) {
  if (const std::optional<DraftPlan> ready = plan_of_ready(table, given)) {
    return written(*ready, table.source, "");
  }
  const RowClock clock = row_clock(table, given);
  return written(plan_draft(inspect_table(table, clock), clock, {}), table.source, "");
}

}  // namespace kelpie::log
