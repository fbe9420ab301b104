// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "log/dataset.hpp"
#include "study/open_loop_study.hpp"

namespace kelpie::format {

/// The scores of rollouts as JSON (docs/method/open_loop.md); NaN becomes null.
std::string rollout_json(const study::OpenLoopResult& result);

/// One rollout as columns: t_s, then X, X_spread (and X_measured, where measured) for every state
/// X, and `beyond`, 1 where an input is outside the range of the training rows.
log::Table trajectory_table(const study::Trajectory& path, const std::vector<std::string>& states);

}  // namespace kelpie::format
