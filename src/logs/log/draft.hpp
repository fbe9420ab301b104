// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bag/inspect.hpp"
#include "log/dataset.hpp"
#include "log/log_config.hpp"
#include "log/log_source.hpp"
#include "log/row_clock.hpp"

namespace kelpie::log {

/// A configuration guessed for a log: velocities and commands are recognised by type, name and unit
/// (tables in known_roles.cpp), never by learning (docs/howto/logs.md).
struct Draft {
  std::string toml;                    ///< the file, a reason beside each line
  std::vector<std::string> taken{};    ///< chosen signals, for the user: a line each
  std::vector<std::string> remarks{};  ///< limits of the data, for the user: a line each
  /// Reasons for an incomplete draft, a line each: equally likely signals, no signal found. Empty:
  /// the log can be learned with the draft.
  std::vector<std::string> open{};
  std::string fields{};  ///< of an incomplete draft: what the log has that changes, for the user
  bool has_targets = false;  ///< velocities are known, whose derivatives are the targets

  bool is_complete() const { return open.empty(); }
  /// What an incomplete draft leaves open, and the remedy, for the user: a line each; `more`: what
  /// else is open.
  std::string unclear(const std::string& source, const std::string& more = "") const;
  /// The configuration; messages call the draft's log `source`. Requires is_complete().
  LogConfig config(const std::string& source) const;
  /// The chosen signals and the limits of the data of the log called `source`, for the user.
  std::string summary(const std::string& source) const;
};

/// Content of a table, as the fields of a topic without name.
bag::BagReport inspect_table(const Table& table, const RowClock& clock);

/// A CSV file, with what is known of its numbers before any role: pulses of disarmed motors
/// (set_missing_pulses()), the unit of the time (settle_time_unit()). Columns in `given.units` have
/// no unit but the time, since whoever reads the table converts them. `told`: lines for the user.
Table read_table(const std::filesystem::path& file, const Roles& given, std::string& told);

/// Drafts a configuration for the log. Never throws because of the log's content: unclear points
/// become `open`.
Draft draft_of(const bag::BagReport& report, const LogSource& source);
/// Drafts a configuration for a table. A table with the usual names (guess_roles) is used directly.
/// `given`: the time or the rate that the caller knows.
Draft draft_of(const Table& table, const Roles& given = {});

/// Content of a log, and the draft.
struct InspectedLog {
  bag::BagReport report;
  Draft draft;
  std::string losses{};  ///< as Log::losses, for people: a line each
};

/// Reads the whole log; `given` as for tables. Throws as bag::open_bag(), bag::inspect_bag() and
/// read_csv() do.
InspectedLog inspect_log(const LogSource& source, const Roles& given = {});

/// The draft alone.
inline Draft draft_of(const LogSource& source) {
  return inspect_log(source).draft;
}

}  // namespace kelpie::log
