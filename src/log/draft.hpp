// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bag/inspect.hpp"
#include "log/dataset.hpp"
#include "log/log_config.hpp"
#include "log/log_source.hpp"

namespace kelpie::log {

/// A configuration guessed for a log: which signals are velocities and commands, by types, names
/// and units (known_roles.cpp is all that is known of them), never by what is learned from them
/// (docs/templates.md).
struct Draft {
  std::string toml;                    ///< the file, a reason beside each line
  std::vector<std::string> taken{};    ///< what it takes, for people: a line each
  std::vector<std::string> remarks{};  ///< what the data can't give, alike
  /// Why it isn't complete: two signals that are as likely, nothing found; a line each. Empty: the
  /// log can be learned with it.
  std::vector<std::string> open{};

  bool is_complete() const { return open.empty(); }
  /// The configuration; messages about it name `source`. Requires is_complete().
  LogConfig config(const std::string& source) const;
  /// What it took of the log called `source`, and what that can't give, for people.
  std::string summary(const std::string& source) const;
};

/// What a table holds, as the fields of one topic without a name.
bag::BagReport inspect_table(const Table& table);

/// The draft for a log that holds this. Throws nothing on what the log holds: what can't be told is
/// open.
Draft draft_of(const bag::BagReport& report, const LogSource& source);
/// The same of a table. One with the usual names (guess_roles) is taken as it is.
Draft draft_of(const Table& table);

/// What a log holds, and the draft for it.
struct InspectedLog {
  bag::BagReport report;
  Draft draft;
  std::string losses{};  ///< of a damaged bag, for people: a line each
};

/// Cost: reads the whole of it. Throws as bag::open_bag, bag::inspect_bag and read_csv do.
InspectedLog inspect_log(const LogSource& source);

/// The draft alone.
inline Draft draft_of(const LogSource& source) {
  return inspect_log(source).draft;
}

}  // namespace kelpie::log
