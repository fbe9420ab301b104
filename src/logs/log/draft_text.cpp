// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/text.hpp"
#include "log/draft_plan.hpp"

namespace kelpie::log {
namespace {

// A line of a comment holds no line ends, whatever a log's names hold.
std::string comment(const std::string& text) {
  return can_be_written(text) ? "# " + text + "\n" : "";
}

std::string list_text(const std::vector<std::string>& names) {
  std::vector<std::string> literals;
  std::ranges::transform(names, std::back_inserter(literals), toml_text);
  return "[" + join_text(literals, ", ") + "]";
}

std::string line_text(const DraftPlan::Line& line, bool is_taken) {
  return fmt::format("{}{} = {}{}\n", is_taken ? "" : "# ", line.name, toml_text(line.from),
                     line.why.empty() || !can_be_written(line.why) ? "" : "  # " + line.why);
}

std::string groups_text(const std::vector<DraftPlan::Group>& groups) {
  std::string text;
  for (const DraftPlan::Group& group : groups) {
    text += comment(group.head);
    for (const DraftPlan::Line& line : group.lines) {
      text += line_text(line, group.is_taken);
    }
  }
  return text;
}

std::string head_text(const DraftPlan& plan, const std::string& log) {
  std::string text = comment("A draft for " + log + ", guessed from types, names and units.");
  text += comment("Look at the reasons, change what is wrong; then");
  text += comment("  kelpie learn " + log + " --config THIS_FILE");
  text += comment("docs/howto/logs.md explains every key.");
  if (!plan.open.empty()) {
    text += "#\n" + comment("INCOMPLETE. Open points:");
  }
  for (const std::string& line : plan.open) {
    text += comment("- " + line);
  }
  if (!plan.remarks.empty()) {
    text += "#\n" + comment("Limits of this log:");
  }
  for (const std::string& line : plan.remarks) {
    text += comment("- " + line);
  }
  return text;
}

std::string keys_text(const DraftPlan& plan, const std::string& definitions) {
  std::string text = "\n[log]\n";
  const std::string absent = plan.inputs.empty() || plan.targets.empty() ? "# " : "";
  text += fmt::format("{}inputs = {}\n{}targets = {}\n", absent, list_text(plan.inputs), absent,
                      list_text(plan.targets));
  if (!plan.time.empty()) {
    text += fmt::format("time = {}  # s\n", toml_text(plan.time));
  }
  if (plan.rate_hz > 0.0) {
    text += fmt::format("rate = {:.4g}  # rows per second: {}\n", plan.rate_hz, plan.rate_why);
  }
  if (!plan.derived.empty() || !plan.pose.empty()) {
    if (plan.is_of_bag) {
      text += plan.clock == bag::Clock::header
                  ? "clock = \"header\"  # all these messages have their senders' time\n"
                  : "clock = \"receive\"  # not all messages have a sender's time of one clock\n";
    }
    text += fmt::format("gap = {:.4g}  # s: longer silences aren't bridged\n", plan.gap_s);
  }
  if (!plan.pose.empty()) {
    text += "pose = " + plan.pose + "\n";
    text += "window = \"auto\"  # s: velocities and accelerations are integrals over so long\n";
  }
  if (!plan.derived.empty()) {
    text +=
        fmt::format("window = {:.4g}  # s: accelerations are slopes over so long\n", plan.window_s);
    text +=
        "filter = \"centred\"  # for logs; \"causal\" for a vehicle that learns while it moves\n";
  }
  if (plan.armed_only) {
    text += "armed_only = true  # messages while the motors are disarmed are left out\n";
  }
  if (plan.is_of_bag && !definitions.empty()) {
    text +=
        fmt::format("messages = {}\n",
                    toml_text(std::filesystem::absolute(definitions).lexically_normal().string()));
  }
  if (!plan.vectors.empty()) {
    text += fmt::format("vectors = [{}]\n", join_text(plan.vectors, ", "));
  }
  std::vector<std::string> units;
  for (const DraftPlan::Line& unit : plan.units) {
    units.push_back(fmt::format("{} = {}", unit.name, toml_text(unit.from)));
  }
  if (!units.empty()) {
    text += fmt::format("units = {{{}}}\n", join_text(units, ", "));
  }
  return text;
}

// A lever arm takes all velocities and rates; how long it is can't be guessed.
std::string lever_arm_text(const DraftPlan& plan) {
  std::size_t found = 0;
  for (const DraftPlan::Group& group : plan.states) {
    for (const DraftPlan::Line& line : group.lines) {
      found += group.is_taken && line.name.size() == 1 &&
               std::string_view("uvwpqr").find(line.name) != std::string_view::npos;
    }
  }
  return found < 6 ? ""
                   : "# lever_arm = {velocity = [\"u\", \"v\", \"w\"], rates = [\"p\", \"q\", "
                     "\"r\"], arm = [0.0, 0.0, 0.0]}  # m: where the velocity is measured, seen "
                     "from where it is wanted\n";
}

}  // namespace

std::string draft_text(const DraftPlan& plan, const std::string& log,
                       const std::string& definitions) {
  std::string text = head_text(plan, log) + keys_text(plan, definitions) + lever_arm_text(plan);
  if (!plan.states.empty()) {
    text += "\n[log.states]  # lines between messages\n" + groups_text(plan.states);
  }
  if (!plan.commands.empty()) {
    text += "\n[log.commands]  # hold until the next message\n" + groups_text(plan.commands);
  }
  if (!plan.others.empty()) {
    text += "\n# Fields that change; lines of [log.states] and [log.commands] name the columns:\n";
    for (const DraftPlan::Line& line : plan.others) {
      text += comment(fmt::format("  NAME = {}  # {}", toml_text(line.from), line.why));
    }
  }
  if (!plan.scales.empty()) {
    text += "\n[log.scale]  # about + by (value - about)\n";
    for (const DraftPlan::Line& line : plan.scales) {
      text += fmt::format("{} = {}  # {}\n", line.name, line.from, line.why);
    }
  }
  if (!plan.valid.empty()) {
    text += "\n[log.valid]  # velocities count where the field is at least so large\n";
    for (const DraftPlan::Line& line : plan.valid) {
      text += fmt::format("{} = {}  # {}\n", toml_text(line.name), line.from, line.why);
    }
  }
  if (!plan.neutrals.empty()) {
    text += "\n[log.actuators]  # commands at rest\n";
    for (const DraftPlan::Line& line : plan.neutrals) {
      text += fmt::format("{} = {{neutral = {}}}  # {}\n", line.name, line.from, line.why);
    }
  }
  if (!plan.derived.empty()) {
    text += "\n[log.derived]\n";
    for (const DraftPlan::Line& line : plan.derived) {
      text += fmt::format("{} = \"d({})\"\n", line.name, line.from);
    }
  }
  return text;
}

}  // namespace kelpie::log
