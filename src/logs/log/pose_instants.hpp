// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "kelpie/stream/stream_plan.hpp"
#include "log/dataset.hpp"
#include "log/signal.hpp"

namespace kelpie::log {

/// Columns of the poses in pose_instants(), before the other sources.
inline constexpr std::array<const char*, 4> kInstantColumns{"t", "x", "y", "heading"};

/// Poses and the other sources at the times of the rows themselves, where the rows of a pose hold
/// means over a window: kInstantColumns [s, m, m, rad], then a column per source beside the pose.
/// The heading is continuous. Commands as frequent as the rows change in straight lines between
/// samples. Empty unless the plan has x, y and a heading. Requires a valid plan with lags and
/// `signals` of its sources, sorted. Throws as StreamedSignals does.
Table pose_instants(const StreamPlan& plan, std::vector<Signal> signals);

/// Fills Dataset::poses and pose_inputs of the data's rows from pose_instants().
void add_pose_instants(const Table& instants, Dataset& data);

}  // namespace kelpie::log
