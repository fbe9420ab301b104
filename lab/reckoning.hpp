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

/// What is asked of every navigator.
struct ReckoningPlan {
  std::vector<double> outages_s{10.0, 30.0, 60.0, 120.0};
  bool yaw_rate = true;  ///< still measured in an outage
  DeadReckoningSettings settings{};
  /// Called now and then with the share done; false stops the work.
  std::function<bool(double)> keep_going = [](double) { return true; };
};

/// What became of all outages of one length, for one navigator.
struct OutageScore {
  double seconds = 0.0;
  std::vector<double> errors;  ///< position error over distance, one per outage
  std::size_t told = 0;        ///< outages in which an ellipse was told,
  std::size_t inside = 0;      ///< and of these those that ended within that of 90 %
};

/// One navigator.
struct NavigatorScore {
  std::string name;
  std::vector<OutageScore> outages;
};

/// A log's outages.
struct ReckoningResult {
  std::string source;
  std::string split;
  bool simulated = false;
  bool yaw_rate = true;
  std::size_t held_out = 0;  ///< rows
  std::vector<NavigatorScore> scores;

  /// Adds the outages of another log of the same kind.
  void join(const ReckoningResult& other);
};

/// All navigators go along the whole log; wherever an outage fits into the held-out rows, a copy of
/// each goes through it without surge and sway. Outages begin half their length apart, as in
/// `kelpie rollout`, the first of them two seconds after the held-out rows begin or the log was
/// cut: nobody who doubts a wild ping believes the first sample after a cut. Those in which the
/// vehicle went less than 0.1 m don't count. Requires inputs u, v, r first.
ReckoningResult measure_reckoning(const log::Dataset& data, const study::Split& split,
                                  const ReckoningPlan& plan);

}  // namespace kelpie::lab
