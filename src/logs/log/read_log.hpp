// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>

#include "bag/series.hpp"
#include "log/dataset.hpp"
#include "log/draft.hpp"
#include "log/log_config.hpp"
#include "log/log_source.hpp"
#include "log/sampling.hpp"

namespace kelpie::log {

/// A log, converted to a table.
struct Log {
  Table table;
  Roles roles;                ///< as given, with the time and rate of the table
  Table instants{};           ///< Samples::instants
  SamplingReport sampling{};  ///< result of sampling; no sources: the log was a table of samples
  /// Losses of a damaged bag, and pulses that a table lacks (set_missing_pulses()), for the user: a
  /// line each.
  std::string losses{};
  std::size_t disarmed = 0;  ///< messages left out because motors were disarmed
  /// Units of a bag's columns and of Roles::units, for display; units of a CSV are in Table::units.
  std::map<std::string, std::string> units{};
  std::vector<Mistake> doubts{};  ///< Dataset::doubts
  std::optional<Draft> draft{};   ///< the draft used without configuration

  /// The data for a learner; missing roles are guessed from the names, and inputs of a table that
  /// are pulses of servos, in whole µs to both sides of 1500, rest at 1500 unless an actuator is
  /// given. Throws as guess_roles() and make_dataset() do.
  Dataset dataset() const;
};

/// Time column and rate for rows without time, from `roles`, or else from `config`.
bag::RowTimes row_times(const LogConfig& config, const Roles& roles);

/// Units of the sampled columns that have a unit in `roles`: converted to the SI, derivatives as
/// their sources.
std::map<std::string, std::string> row_units(const StreamPlan& plan, const Roles& roles);

/// Reads any recorded data; the only entry. If `config` names states or commands, the log's signals
/// are sampled at a common rate (docs/howto/logs.md). Otherwise a table with all `roles.inputs`,
/// or with the usual names (guess_roles), is used directly; a bag, and any other table, is read
/// with a draft. `roles` are the caller's roles, or else the roles of `config`. Throws InputError:
/// as reading and sampling do; an incomplete draft, with the open points; a missing or meaningless
/// rate or time.
Log read_log(const LogSource& source, const LogConfig& config, const Roles& roles);

/// Facts about a log that a stream of the messages cannot know in advance.
struct Reach {
  std::int64_t origin_ns = 0;  ///< the earliest stamp of a message in use: where times count from
  double end_s = 0.0;          ///< when the first signal ends, since then: no row lies later

  bool operator==(const Reach&) const = default;
};

/// Reads the whole bag for these facts. Requires given lags. Throws as bag::open_bag() and
/// bag::read_series() do, and on a signal without a finite value.
Reach read_reach(const LogSource& source, const LogConfig& config);

/// Reads columns of a bag as recorded: a row per message of the first column's topic (held_table).
/// Throws as bag::open_bag() and bag::read_series() do.
Log read_columns(const LogSource& source, std::span<const std::string> columns, bag::Clock clock);

}  // namespace kelpie::log
