// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "study/tune.hpp"

namespace kelpie::synthetic {

/// A search with one rung and one candidate, which was given up.
inline study::TuneResult small_search() {
  study::TuneResult result;
  result.tuned = ModelSettings::from_preset("default", 3);
  result.tuned.axes[1].gamma = 0.777;
  result.references = {{"default", ModelSettings::from_preset("default", 3)},
                       {"paper", ModelSettings::from_preset("paper", 3)}};
  result.rungs = {100};
  result.logs = {{"log.csv", 100, {{{{0, 25, 100}}, 100}}}};
  const study::TuneScores scores{
      .tuned = 0.912, .base = 0.9, .references = {0.881, NAN}, .least_squares = 0.701};
  for (const char* const name : {"udot", "vdot", "rdot"}) {
    result.axes.push_back({name, 0.912, 0, scores, {scores}});
  }
  study::ChainScore given_up;
  given_up.given_up = true;
  result.evaluations = {{{0, "udot", 0, "c=1"}, given_up}};
  result.trials = {{"udot", 0, "c=1", NAN, 0.0, true}};
  return result;
}

/// The same over two logs, on the second of which the tuned settings lose.
inline study::TuneResult search_of_two_logs() {
  study::TuneResult result = small_search();
  result.logs.push_back({"other <log>.csv", 80, result.logs.front().rungs});
  for (study::TunedAxis& axis : result.axes) {
    axis.logs.push_back(axis.logs.front());
  }
  result.axes[1].logs[1].tuned = 0.805;
  return result;
}

}  // namespace kelpie::synthetic
