// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "study/open_loop_study.hpp"

namespace kelpie::synthetic {

/// Of two models, two horizons and two states, one of them with a hostile name.
inline study::OpenLoopResult small_rollout() {
  study::OpenLoopResult result;
  result.source = "<log>.csv";
  result.model = "model.json";
  result.split = "held out: all";
  result.rows = 1234;
  result.stretches = 2;
  result.states = {"u", "r&d"};
  result.units = {"m/s", ""};
  for (const char* const name : {"kelpie", "velocity held"}) {
    study::OpenLoopScore& score = result.scores.emplace_back();
    score.name = name;
    for (const double seconds : {1.0, 10.0}) {
      score.horizons.push_back({seconds, 40, {0.951, -3.0}, {0.01, 0.02}, {0.9, NAN}, 0.25});
    }
    score.reckoning = {{10.0, 12, 0.05, 0.111}};
  }
  result.example.states = {0, 1};
  result.example.time_s = {0.0, 0.5, 1.0};
  result.example.measured = {{1, 2, 3}, {1, 1, 1}};
  result.example.velocity = {{1, 2.1, 3.2}, {1, 1.1, 1.2}};
  result.example.spread = {{0, 0.1, 0.2}, {0, 0.1, 0.2}};
  result.example.beyond = {false, false, true};
  return result;
}

}  // namespace kelpie::synthetic
