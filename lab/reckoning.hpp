// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "kelpie/navigation/dead_reckoning.hpp"
#include "log/dataset.hpp"
#include "study/split.hpp"

namespace kelpie::lab {

/// What a velocity log says in an outage.
enum class OutageKind {
  silent,  ///< nothing
  zeros,   ///< exact zeros
  frozen,  ///< the last velocity
};

/// The outages of a study of dead reckoning. Navigators without checks of their own hear nothing in
/// any outage.
struct ReckoningPlan {
  std::vector<double> outages_s{10.0, 30.0, 60.0, 120.0};
  bool yaw_rate = true;  ///< still measured in an outage
  OutageKind kind = OutageKind::silent;
  DeadReckoningSettings settings{};
  /// Called now and then with the finished share; false stops the work.
  std::function<bool(double)> keep_going = [](double) { return true; };
};

/// The outages of one length, for a navigator.
struct OutageScore {
  double seconds = 0.0;
  std::vector<double> errors;       ///< position error over distance, one per outage
  std::size_t told = 0;             ///< outages with an error ellipse
  std::size_t inside = 0;           ///< outages that ended inside the 90 % ellipse
  std::size_t velocity_inside = 0;  ///< of `told`: within the 90 % ellipse of surge and sway
  std::vector<double> steps;    ///< largest step of each outage's return, in standard deviations
  std::vector<double> found_s;  ///< until each disguised loss was recognised; infinite: never
};

/// A navigator and its scores.
struct NavigatorScore {
  std::string name;
  std::vector<OutageScore> outages;
  std::size_t measured = 0;     ///< rows of the log that the navigator followed
  std::size_t disbelieved = 0;  ///< of `measured`: the navigator did not believe surge or sway
};

/// The outages of a log.
struct ReckoningResult {
  std::string source;
  std::string split;
  bool simulated = false;
  bool yaw_rate = true;
  std::size_t held_out = 0;  ///< rows in which outages may lie
  std::vector<NavigatorScore> scores;

  /// Adds the outages of another log of the same kind.
  void join(const ReckoningResult& other);
};

/// Runs every navigator along the whole log. Wherever an outage fits into the held-out rows, a copy
/// of each navigator runs through the outage without surge and sway. Outages begin half their
/// length apart, as in `kelpie rollout`, the first two seconds after the start of the held-out rows
/// or a cut of the log, because outlier filters need some samples after a cut. Outages with less
/// than 0.1 m of travel don't count. Requires inputs u, v, r first.
ReckoningResult measure_reckoning(const log::Dataset& data, const study::Split& split,
                                  const ReckoningPlan& plan);

/// As `kelpie live` does: every navigator follows the log from the first row on, all learn a row
/// after the row has passed, and go on with the models of all rows so far every 10 s. Outages lie
/// anywhere after the first five minutes.
ReckoningResult measure_live_reckoning(const log::Dataset& data, const ReckoningPlan& plan);

/// A table per result, for a terminal.
std::string reckoning_table(const std::vector<ReckoningResult>& results);

/// All results as JSON (docs/method/open_loop.md).
std::string reckoning_json(const std::vector<ReckoningResult>& results);

}  // namespace kelpie::lab
