// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "bag/series.hpp"
#include "file/toml.hpp"
#include "kelpie/core/error.hpp"
#include "log/dataset.hpp"
#include "log/sampling.hpp"

namespace kelpie::log {

/// The table [log] of a configuration file: roles of the columns, and the conversion of signals to
/// samples (docs/howto/logs.md).
struct LogConfig {
  std::string source;  ///< the file, for messages
  Roles roles;
  SamplingPlan plan;  ///< without rate and responses, given by the roles
  bag::Clock clock = bag::Clock::receive;
  bool armed_only = false;     ///< leave out messages while motors are disarmed (AutopilotState)
  bool mirror_motors = false;  ///< outputs as the frame's table has them (pulse_factor())
  std::filesystem::path messages;  ///< folder of .msg files, or empty
  /// Columns that tell whether the velocities of their topic are valid: at this value and above.
  std::map<std::string, double> valid{};
  std::map<std::string, Place> places{};  ///< in the file, of each source's column

  /// Throws an InputError about a source's column, with file, line and key.
  [[noreturn]] void refuse_column(const std::string& column, const std::string& why) const;

  bool makes_samples() const { return !plan.sources.empty(); }
};

/// Reads a table of validity, {"/dvl:velocity_valid" = 1}: the least value of a valid message.
/// Throws InputError (key) on a name that is no column of a recording, and on no number.
void read_validity(const file::TomlNode& table, std::map<std::string, double>& valid);

/// The pose whose parts (x, y, z, roll, pitch, yaw, qw, qx, qy, qz) have sources of these names.
/// Throws InputError on angles beside a quaternion.
StreamPlan::Pose pose_from(const std::map<std::string, std::string>& sources);

/// The roles of the columns of poses where the caller names none: all accelerations but pdot and
/// qdot are targets.
void add_pose_targets(const StreamPlan::Pose& pose, Roles& roles);

/// Reads a configuration file (TOML); settings of the model are skipped. Returns defaults for an
/// empty path, or for a file without [log]. Throws InputError (file, line, key): missing file, no
/// TOML, a value of a wrong kind, an unknown name (with the nearest known name).
LogConfig read_log_config(const std::filesystem::path& file);
/// The same of the file's top-level table.
LogConfig read_log_config(const file::TomlNode& root);

/// The plan for sampling a whole log: the plan of `config` with the rate, and with the targets used
/// for estimating lags. `roles` override the roles of `config`. Throws InputError (file, log.rate)
/// without a rate.
SamplingPlan sampling_plan(const LogConfig& config, const Roles& roles);

/// The plan for sampling live messages as in a log of the same messages (SampleStream), including
/// inputs and targets; missing `roles` are guessed from the names. Throws as sampling_plan() and
/// guess_roles() do, and on a lag to be estimated.
StreamPlan stream_plan(const LogConfig& config, const Roles& roles);

}  // namespace kelpie::log
