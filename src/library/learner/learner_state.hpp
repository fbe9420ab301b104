// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "learner/adaptive_svr.hpp"

namespace kelpie {

/// The states of all mechanisms of one axis at one moment. reference/architecture.md lists those
/// that occur, and the events between them; tests/library/learner/states_test.cpp holds the list.
struct LearnerState {
  /// The comparison of two models by the ChangeDetector.
  enum class Comparison : std::uint8_t {
    none,
    challenger,  ///< errors have grown: a challenger is compared with the champion
    probation,   ///< another model took over: the former model is compared with the champion
  };

  Comparison comparison = Comparison::none;
  AdaptiveSvr::SliceTask task = AdaptiveSvr::SliceTask::none;
  PastModels::State past_models = PastModels::State::settling;
  bool relearning = false;  ///< the committee's other members relearn the learner's buffer

  bool operator==(const LearnerState&) const = default;
};

}  // namespace kelpie
