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

/// A log as a table, whatever it was.
struct Log {
  Table table;
  Roles roles;                ///< as given, with the time and rate of the table
  SamplingReport sampling{};  ///< what was done to its signals; no sources: it is as it was
  std::string losses{};       ///< what of a damaged bag was lost, for people: a line each
  /// Of columns of a bag, and of those of Roles::units, for people; else Table::units has them.
  std::map<std::string, std::string> units{};
  std::optional<Draft> draft{};  ///< where nobody said what to take: what was taken

  /// What a learner is shown; roles that are not given are guessed from the names.
  /// Throws as guess_roles and make_dataset do.
  Dataset dataset() const;
};

/// What `roles`, or else `config`, say of the times of rows that may be without: the column of the
/// time, and the rate.
bag::RowTimes row_times(const LogConfig& config, const Roles& roles);

/// The one door to recorded data. Where `config` names states or commands, the log's signals are
/// put on a common clock (docs/from_topics.md). Where it names none, a table is taken as it is if
/// it has all of `roles.inputs`, or its names tell (guess_roles); a bag, and any other table, is
/// read as the draft for it says. `roles` are what the caller wants the columns to be (those of
/// `config`, or over them). Throws InputError: what reading and sampling throw; a draft that isn't
/// complete, with what is open; a rate or time that is missing or has no meaning.
Log read_log(const LogSource& source, const LogConfig& config, const Roles& roles);

/// What of a log a stream of its messages can't know beforehand.
struct Reach {
  std::int64_t origin_ns = 0;  ///< the earliest stamp of a message in use: where times count from
  double end_s = 0.0;          ///< when the first signal ends, since then: no row lies later

  bool operator==(const Reach&) const = default;
};

/// That of a bag, whose lags have to be given. Cost: reads the whole of it. Throws as
/// bag::open_bag and bag::read_series do, and on a signal without a finite value.
Reach read_reach(const LogSource& source, const LogConfig& config);

/// Columns of a bag as they were recorded: one row per message of the first column's topic
/// (held_table). Throws as bag::open_bag and bag::read_series do.
Log read_columns(const LogSource& source, std::span<const std::string> columns, bag::Clock clock);

}  // namespace kelpie::log
