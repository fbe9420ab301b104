// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "kelpie/stream/stream_plan.hpp"
#include "log/signal.hpp"

namespace kelpie::log {

/// The window of a pose, found in a log.
struct PoseWindowChoice {
  /// A window that was tried.
  struct Tried {
    double half_s = 0.0;
    std::size_t rows = 0;
    /// Per acceleration: share of the variance that least squares with the commands explains on
    /// folds, and without the commands.
    std::vector<double> explained{};
    std::vector<double> without_commands{};
    double score = 0.0;  ///< Σ log F, see find_pose_window()
  };
  double half_s = 0.0;
  std::vector<Tried> tried{};
};

/// Tries windows in ratios of √2 and takes the window in which the commands tell most of the
/// accelerations: the greatest Σ log F over the accelerations,
///
///     F = (R² − R₀²) / (1 − R²) / half_s,
///
/// in proportion to the F statistic of the commands, whose independent rows are fewer the wider the
/// window is. Too narrow a window leaves noise in the accelerations, too wide a one averages the
/// manoeuvres away. R² is of least squares on v, v|v|, vᵢvⱼ, other states, n and n|n| on five folds
/// of 25 pieces; R₀² without the commands, or 0 where there are none. Uses samples up to `until_s`
/// only. Requires: a valid plan with a pose, given lags, signals sorted. Throws InputError (window)
/// where no window has rows enough.
PoseWindowChoice find_pose_window(const StreamPlan& plan, const std::vector<Signal>& signals,
                                  double until_s);

}  // namespace kelpie::log
