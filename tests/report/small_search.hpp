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
  result.rungs = {{{{0, 25, 100}}, 100}};
  for (const char* const name : {"udot", "vdot", "rdot"}) {
    result.axes.push_back({name, 0.912, 0, {0.881, NAN}});
  }
  study::ChainScore given_up;
  given_up.given_up = true;
  result.evaluations = {{{"udot", 0, "c=1"}, given_up}};
  for (study::TunedAxis& axis : result.axes) {
    axis.least_squares = 0.701;
  }
  return result;
}

}  // namespace kelpie::synthetic
