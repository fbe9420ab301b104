// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/text.hpp"
#include "log/draft.hpp"

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

std::string line_text(const Draft::Line& line, bool is_taken) {
  return fmt::format("{}{} = {}{}\n", is_taken ? "" : "# ", line.name, toml_text(line.from),
                     line.why.empty() || !can_be_written(line.why) ? "" : "  # " + line.why);
}

std::string groups_text(const std::vector<Draft::Group>& groups) {
  std::string text;
  for (const Draft::Group& group : groups) {
    text += comment(group.head);
    for (const Draft::Line& line : group.lines) {
      text += line_text(line, group.is_taken);
    }
  }
  return text;
}

std::string head_text(const Draft& draft) {
  std::string text =
      comment("A draft for " + draft.config.source + ", guessed from types, names and units.");
  text += comment("Look at the reasons, change what is wrong; then");
  text += comment("  kelpie learn " + draft.config.source + " --config THIS_FILE");
  text += comment("docs/howto/logs.md explains every key.");
  const auto add = [&](const char* title, const std::vector<std::string>& lines) {
    text += lines.empty() ? "" : "#\n" + comment(title);
    for (const std::string& line : lines) {
      text += comment("- " + line);
    }
  };
  add("INCOMPLETE. Open points:", draft.open);
  add("Limits of this log:", draft.remarks);
  return text;
}

std::string pose_text(const Draft::Group& pose) {
  std::vector<std::string> parts;
  std::ranges::transform(pose.lines, std::back_inserter(parts), [](const Draft::Line& line) {
    return line.name + " = " + toml_text(line.from);
  });
  return "{" + join_text(parts, ", ") + "}";
}

std::string vector_text(const StreamPlan::Vector& vector) {
  return fmt::format("{{columns = {}, from = \"{}\", to = \"{}\", attitude = {}{}}}",
                     list_text({vector.columns.begin(), vector.columns.end()}),
                     frame_name(vector.from), frame_name(vector.to), list_text(vector.attitude),
                     vector.is_in_degrees ? ", angles = \"deg\"" : "");
}

std::string keys_text(const Draft& draft) {
  const LogConfig& config = draft.config;
  const Roles& roles = config.roles;
  const bool is_of_poses = !draft.pose.lines.empty();
  std::string text = "\n[log]\n";
  const std::string absent = roles.inputs.empty() || roles.targets.empty() ? "# " : "";
  text += fmt::format("{}inputs = {}\n{}targets = {}\n", absent, list_text(roles.inputs), absent,
                      list_text(roles.targets));
  if (!roles.time.empty()) {
    text += fmt::format("time = {}  # s\n", toml_text(roles.time));
  }
  if (roles.rate_hz > 0.0) {
    text +=
        fmt::format("rate = {:.4g}  # rows per second: {}\n", roles.rate_hz, draft.whys.at("rate"));
  }
  if (!config.plan.derived.empty() || is_of_poses) {
    if (draft.is_of_bag) {
      text += config.clock == bag::Clock::header
                  ? "clock = \"header\"  # all these messages have their senders' time\n"
                  : "clock = \"receive\"  # not all messages have a sender's time of one clock\n";
    }
    text += fmt::format("gap = {:.4g}  # s: longer silences aren't bridged\n", config.plan.gap_s);
  }
  if (is_of_poses) {
    text += "pose = " + pose_text(draft.pose) + "\n";
    text += "window = \"auto\"  # s: velocities and accelerations are integrals over so long\n";
  }
  if (!config.plan.derived.empty()) {
    text += fmt::format("window = {:.4g}  # s: accelerations are slopes over so long\n",
                        config.plan.derivative.window_s);
    text +=
        "filter = \"centred\"  # for logs; \"causal\" for a vehicle that learns while it moves\n";
  }
  if (config.armed_only) {
    text += "armed_only = true  # messages while the motors are disarmed are left out\n";
  }
  if (!config.messages.empty()) {
    text += fmt::format("messages = {}\n", toml_text(config.messages.string()));
  }
  for (const StreamPlan::Vector& vector : config.plan.vectors) {
    text += "vectors = [" + vector_text(vector) + "]\n";
  }
  std::vector<std::string> units;
  for (const auto& [column, unit] : roles.units) {
    units.push_back(column + " = " + toml_text(unit));
  }
  return text + (units.empty() ? "" : "units = {" + join_text(units, ", ") + "}\n");
}

// A lever arm takes all velocities and rates; how long it is can't be guessed.
std::string lever_arm_text(const Draft& draft) {
  std::size_t found = 0;
  for (const Draft::Group& group : draft.states) {
    for (const Draft::Line& line : group.lines) {
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

std::string Draft::toml() const {
  std::string text = head_text(*this) + keys_text(*this) + lever_arm_text(*this);
  const auto add_table = [&](const char* head, const std::string& lines) {
    text += lines.empty() ? "" : std::string("\n") + head + "\n" + lines;
  };
  const auto why = [&](const std::string& key) {
    const auto found = whys.find(key);
    return found == whys.end() ? "" : "  # " + found->second;
  };
  add_table("[log.states]  # lines between messages", groups_text(states));
  add_table("[log.commands]  # hold until the next message", groups_text(commands));
  std::string lines;
  for (const Line& line : others) {
    lines += comment(fmt::format("  NAME = {}  # {}", toml_text(line.from), line.why));
  }
  add_table("# Fields that change; lines of [log.states] and [log.commands] name the columns:",
            std::exchange(lines, ""));
  for (const StreamPlan::Source& source : config.plan.sources) {
    const std::string scale =
        source.about == 0.0 ? fmt::format("{}", source.scale)
                            : fmt::format("{{by = {}, about = {}}}", source.scale, source.about);
    lines +=
        source.scale == 1.0 ? "" : source.name + " = " + scale + why("scale." + source.name) + "\n";
  }
  add_table("[log.scale]  # about + by (value - about)", std::exchange(lines, ""));
  for (const auto& [column, least] : config.valid) {
    lines += fmt::format("{} = {}{}\n", toml_text(column), least, why("valid." + column));
  }
  add_table("[log.valid]  # velocities count where the field is at least so large",
            std::exchange(lines, ""));
  for (const auto& [name, actuator] : config.roles.actuators) {
    lines +=
        fmt::format("{} = {{neutral = {}}}{}\n", name, actuator.neutral, why("actuators." + name));
  }
  add_table("[log.actuators]  # commands at rest", std::exchange(lines, ""));
  for (const StreamPlan::Derived& one : config.plan.derived) {
    lines += fmt::format("{} = \"d({})\"\n", one.name, one.of);
  }
  add_table("[log.derived]", lines);
  return text;
}

}  // namespace kelpie::log
