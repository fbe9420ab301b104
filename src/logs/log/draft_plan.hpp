// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <vector>

#include "bag/series.hpp"
#include "log/candidates.hpp"
#include "log/dataset.hpp"
#include "log/row_clock.hpp"

namespace kelpie::log {

/// Content of a draft, before formatting.
struct DraftPlan {
  /// A line "name = column", with why.
  struct Line {
    std::string name;
    std::string from;
    std::string why;
  };
  /// Signals of one part. Groups that are not taken are written as comments.
  struct Group {
    std::string head;  ///< a comment above
    std::vector<Line> lines;
    bool is_taken = true;
  };

  std::vector<std::string> inputs{};
  std::vector<std::string> targets{};
  std::string time{};  ///< a table's column
  double rate_hz = 0.0;
  std::string rate_why{};
  bool is_of_bag = false;
  bag::Clock clock = bag::Clock::receive;
  double gap_s = 1.0;
  double window_s = 0.5;
  std::vector<std::string> vectors{};  ///< in the syntax of [log]
  std::string pose{};                  ///< in the syntax of [log]; "": velocities are known
  std::vector<Line> units{};           ///< `from` is the unit
  std::vector<Group> states{};
  std::vector<Group> commands{};
  std::vector<Line> neutrals{};  ///< `from` is the command at rest
  std::vector<Line> scales{};    ///< `from` is the factor, in the syntax of [log.scale]
  std::vector<Line> valid{};  ///< `name` is the column, `from` the least value of a valid message
  bool armed_only = false;
  std::vector<Line> derived{};  ///< `from` is the differentiated column
  /// Fields of the log that change, where no velocities or no commands are known; without `name`.
  std::vector<Line> others{};

  std::vector<std::string> taken{};    ///< as Draft::taken
  std::vector<std::string> remarks{};  ///< Draft::remarks
  std::vector<std::string> open{};     ///< Draft::open
};

/// Chooses the signals by rank. `clock`: of a table; `of_world`: topics of odometry whose twist
/// lies along the axes of the world.
DraftPlan plan_draft(const bag::BagReport& report, RowClock clock,
                     const std::set<std::string>& of_world);

/// Formats the file. `log` is the name of the log, `definitions` the folder of .msg files or "".
std::string draft_text(const DraftPlan& plan, const std::string& log,
                       const std::string& definitions);

}  // namespace kelpie::log
