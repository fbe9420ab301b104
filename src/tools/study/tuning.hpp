// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace kelpie::study {

/// Behavioural constants of evaluation and search. Unless a source is named, a value was chosen by
/// hand and no measurement is recorded.
inline constexpr struct Tuning {
  struct Stream {
    std::size_t looks = 200;     ///< validation points by default; the resolution of figures
    std::size_t settled = 1000;  ///< samples before r2_min_after_1000 counts; docs/result.md
  } stream;

  struct Baselines {
    double huber = 3.0;               ///< usual errors; the usual clip of Huber's weights
    std::size_t most_velocities = 6;  ///< degrees of freedom of a rigid body
  } baselines;

  /// Plausibility: in CSV logs of real and simulated vehicles ratios lie between 0.83 and 1.08
  /// where the correlation is 0.8 or more; in an autopilot's log at rest on a bench one is 0.38.
  struct Plausibility {
    std::array<double, 2> windows_s{1.0, 5.0};
    std::size_t least_rows = 5;      ///< of a window: by hand
    double least_windows = 20.0;     ///< by hand
    double longest_window = 1.5;     ///< of its usual length: by hand
    double least_correlation = 0.8;  ///< for a ratio that shows a mistake
    double unrelated = 0.5;          ///< below, a shift is looked for
    double late_correlation = 0.9;   ///< at a shift that is a mistake: by hand
    double least_ratio = 0.6;
    double most_ratio = 1.7;
    double least_unknown = 0.2;  ///< of a ratio that no known unit explains: by hand
    double most_unknown = 5.0;
    double near = 0.2;          ///< distance of a ratio from a known factor
    double most_late_s = 5.0;   ///< by hand
    double late_step_s = 0.25;  ///< by hand
  } plausibility;

  struct Intervals {
    std::size_t novelty_bins = 10;  ///< of [0, 1], for the figure of error against novelty
  } intervals;

  struct Split {
    std::size_t pieces = 25;  ///< five held-out pieces of a short log; docs/result.md
  } split;

  /// docs/tuning.md describes the rungs.
  struct ForwardChain {
    std::size_t stretches = 5;                ///< scores per window
    std::size_t windows = 3;                  ///< early, middle, late
    std::array<std::size_t, 2> parts{18, 6};  ///< rows / part in a window of the first two rungs
    std::size_t keep_one_in = 3;              ///< candidates for the next rung: successive halving
    std::size_t rows_between_watches = 32;    ///< progress alone; no result depends on the value
  } chain;

  /// A target has to be the slope of its velocity; docs/identify.md.
  struct Identification {
    double least_correlation = 0.5;
    double least_slope = 0.5;
    double most_slope = 2.0;
    double added_share = 0.2;   ///< surge added mass / mass, where unknown; docs/identify.md
    double added_error = 0.15;  ///< standard error of added_share; docs/identify.md
  } identification;

  struct OpenLoop {
    double jump = 4.0;     ///< usual accelerations; a larger jump ends a stretch, if it is
    double noise = 15.0;   ///< median jumps, too: ten standard deviations of noise; by hand
    double still_m = 0.1;  ///< shorter outages have no relative position error
    double example_every_s = 10.0;  ///< between starts considered for the example
  } open_loop;
} kTuning;

}  // namespace kelpie::study
