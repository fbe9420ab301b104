// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
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
  /// A signal, with why.
  struct Line {
    std::string name;
    std::string from;
    std::string why{};
  };
  /// Signals of one part. Groups that are not taken are written as comments.
  struct Group {
    std::string head;  ///< a comment above
    std::vector<Line> lines{};
    bool is_taken = true;
  };

  LogConfig config{};  ///< `source` is the log; complete where is_complete()
  /// Of keys of [log] that need a reason: "rate", "scale.u", "valid./dvl:velocity_valid".
  std::map<std::string, std::string> whys{};
  std::vector<Group> states{};
  std::vector<Group> commands{};
  Group pose{};  ///< without lines: velocities are known
  /// Fields of the log that change, where no velocities or no commands are known; without `name`.
  std::vector<Line> others{};
  bool is_of_bag = false;
  std::vector<std::string> taken{};    ///< chosen signals, for the user: a line each
  std::vector<std::string> remarks{};  ///< limits of the data, for the user: a line each
  /// Reasons for an incomplete draft, a line each: equally likely signals, no signal found. Empty:
  /// the log can be learned with the draft.
  std::vector<std::string> open{};

  bool is_complete() const { return open.empty(); }
  /// The configuration file, a reason beside each line.
  std::string toml() const;
  /// What an incomplete draft leaves open, and the remedy, for the user: a line each; `more`: what
  /// else is open.
  std::string unclear(const std::string& more = "") const;
  /// The chosen signals and the limits of the data, for the user.
  std::string summary() const;
};

/// Chooses the signals of a log's content by rank, for draft_of(). `clock`: of a table; `of_world`:
/// topics of odometry whose twist lies along the axes of the world; of `given` the rate, the poses
/// and the inputs beside poses.
Draft plan_draft(const bag::BagReport& report, const RowClock& clock,
                 const std::set<std::string>& of_world, const Roles& given = {});

/// Content of a table, as the fields of a topic without name.
bag::BagReport inspect_table(const Table& table, const RowClock& clock);

/// A CSV file, with what is known of its numbers before any role: pulses of disarmed motors
/// (set_missing_pulses()), the unit of the time (settle_time_unit()). Columns in `given.units` have
/// no unit but the time, since whoever reads the table converts them. `told`: lines for the user.
Table read_table(const LogSource& source, const Roles& given, std::string& told);

/// Drafts a configuration for the log. Never throws because of the log's content: unclear points
/// become `open`.
Draft draft_of(const bag::BagReport& report, const LogSource& source);
/// Drafts a configuration for a table. A table with the usual names (guess_roles) is used directly.
/// `given`: the time, the rate or the poses (with the inputs beside the poses) that the caller
/// knows. Throws InputError on a given column that is missing, holds words, or is no part of a
/// pose.
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
