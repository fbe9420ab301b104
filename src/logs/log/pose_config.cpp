// SPDX-License-Identifier: Apache-2.0
#include "log/pose_config.hpp"
#include "log/row_clock.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/text.hpp"
#include "file/toml.hpp"
#include "kelpie/core/error.hpp"
#include "log/candidates.hpp"
#include "log/draft.hpp"
#include "log/draft_plan.hpp"
#include "log/known_roles.hpp"
#include "log/signal.hpp"
#include "log/tuning.hpp"

namespace kelpie::log {
namespace {

[[noreturn]] void refuse_pose(const Table& table, const std::string& field,
                              const std::string& why) {
  throw InputError({.file = table.source, .field = field}, why);
}

// Commands by name; of several readings none.
std::vector<std::string> commands_of(const Table& table) {
  std::vector<Candidate> likely;
  for (Candidate& one : find_candidates(inspect_table(table, {}))) {
    if (one.part == Part::commands && (likely.empty() || one.rank == likely.front().rank)) {
      likely.push_back(std::move(one));
    }
  }
  if (likely.size() != 1) {
    refuse_pose(table, "--inputs",
                likely.empty() ? "names the commands beside a pose, where no column is known as one"
                               : "says which commands stand beside the pose: " + likely[0].what +
                                     ", or " + likely[1].what);
  }
  std::vector<std::string> names;
  for (const CandidateColumn& column : likely.front().columns) {
    names.push_back(column.name);
  }
  return names;
}

double slowest_hz(const Table& table, const RowClock& clock,
                  const std::vector<std::string>& columns) {
  const std::vector<double> times_s = row_times_s(table, clock.column, clock.rate_hz);
  double slowest = std::numeric_limits<double>::infinity();
  for (const std::string& name : columns) {
    Signal signal;
    for (std::size_t row = 0; row < table.rows(); ++row) {
      if (std::isfinite(times_s[row]) && std::isfinite(table.columns[table.find(name)][row])) {
        signal.times_s.push_back(times_s[row]);
        signal.values.push_back(table.columns[table.find(name)][row]);
      }
    }
    sort_by_time(signal);
    const double step_s = median_step_s(signal);
    slowest = step_s > 0.0 ? std::min(slowest, 1.0 / step_s) : slowest;
  }
  if (!std::isfinite(slowest)) {
    refuse_pose(table, clock.column, "tells no time between the poses");
  }
  return slowest;
}

}  // namespace

LogConfig pose_config(const Table& table, const Roles& roles) {
  std::vector<std::string> parts;    // x = "px"
  std::vector<std::string> columns;  // of the pose
  for (const std::string& name : roles.pose) {
    const std::size_t sign = name.find('=');
    columns.push_back(sign == std::string::npos ? name : name.substr(sign + 1));
    const std::optional<std::string> part =
        sign == std::string::npos ? pose_part_by_name(name) : std::optional(name.substr(0, sign));
    table.require_numbers(table.find(columns.back()));
    if (!part) {
      refuse_pose(table, name,
                  "names no part of a pose; write x=" + name +
                      ", or y, z, roll, pitch, yaw, qw, qx, qy, qz");
    }
    parts.push_back(*part + " = " + toml_text(columns.back()));
  }
  const RowClock clock = row_clock(table, roles);
  if (clock.column.empty() && clock.rate_hz == 0.0) {
    refuse_pose(table, "--time", "names the column of the time, which poses take");
  }
  std::vector<std::string> others;
  std::vector<std::string> wanted = roles.inputs.empty() ? commands_of(table) : roles.inputs;
  for (const std::string& label : {roles.configuration, roles.held_out}) {
    if (!label.empty() && std::ranges::count(wanted, label) == 0) {
      wanted.push_back(label);
    }
  }
  for (const std::string& name : wanted) {
    const bool is_of_pose = std::ranges::count(StreamPlan::Pose::kVelocities, name) > 0 ||
                            std::ranges::count(columns, name) > 0;
    if (!is_of_pose) {
      table.require_numbers(table.find(name));
      others.push_back(toml_text(name) + " = " + toml_text(name));
    }
  }
  const double hz = slowest_hz(table, clock, columns);
  const std::string time = clock.column.empty() ? "" : "time = " + toml_text(clock.column);
  const std::string text =
      fmt::format("[log]\n{}\nrate = {:.6g}\ngap = {:.6g}\npose = {{{}}}\n[log.commands]\n{}\n",
                  time, std::min(kTuning.usual_rate_hz, hz), std::max(1.0, 3.0 / hz),
                  join_text(parts, ", "), join_text(others, "\n"));
  return read_log_config(file::TomlNode::parse(text, table.source));
}

void add_pose_targets(const StreamPlan::Pose& pose, Roles& roles) {
  if (roles.targets.empty()) {
    roles.targets = pose.accelerations();
    std::erase_if(roles.targets,
                  [](const std::string& name) { return name == "pdot" || name == "qdot"; });
  }
}

}  // namespace kelpie::log
