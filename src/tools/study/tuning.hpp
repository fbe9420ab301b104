// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace kelpie::study {

/// Behavioural constants of evaluation and search. Unless a source is named, a value was chosen by
/// hand and no measurement is recorded.
inline constexpr struct Tuning {
  struct Stream {
    std::size_t looks = 200;     ///< validation points by default; the resolution of figures
    std::size_t settled = 1000;  ///< samples before r2_min_after_1000 counts; reference/files.md
  } stream;

  struct Baselines {
    double huber = 3.0;               ///< usual errors; the usual clip of Huber's weights
    std::size_t most_velocities = 6;  ///< degrees of freedom of a rigid body
  } baselines;

  struct Intervals {
    std::size_t novelty_bins = 10;  ///< of [0, 1], for the figure of error against novelty
  } intervals;

  struct Split {
    std::size_t pieces = 25;  ///< five held-out pieces of a short log; docs/reference/files.md
  } split;

  /// docs/howto/studies.md; by hand.
  struct Comparison {
    double clear_gain = 0.01;  ///< of R², mean over the axes, that a recommendation takes
    std::size_t least_inner_rows = 300;  ///< training rows for inner splits
  } comparison;

  /// docs/howto/studies.md describes the rungs.
  struct ForwardChain {
    std::size_t stretches = 5;                ///< scores per window
    std::size_t windows = 3;                  ///< early, middle, late
    std::array<std::size_t, 2> parts{18, 6};  ///< rows / part in a window of the first two rungs
    std::size_t keep_one_in = 3;              ///< candidates for the next rung: successive halving
    double least_gain = 0.005;  ///< of the score, over the settings at the start; by hand
    std::size_t rows_between_watches = 32;  ///< progress alone; no result depends on the value
  } chain;

  /// A target has to be the slope of its velocity; docs/howto/identify.md.
  struct Identification {
    double least_correlation = 0.5;
    double least_slope = 0.5;
    double most_slope = 2.0;
    double added_share = 0.2;   ///< surge added mass / mass, where unknown; docs/howto/identify.md
    double added_error = 0.15;  ///< standard error of added_share; docs/howto/identify.md
  } identification;

  struct OpenLoop {
    double jump = 4.0;     ///< usual accelerations; a larger jump ends a stretch, if it is
    double noise = 15.0;   ///< median jumps, too: ten standard deviations of noise; by hand
    double still_m = 0.1;  ///< shorter outages have no relative position error
    double example_every_s = 10.0;  ///< between starts considered for the example
  } open_loop;

  /// Vehicles as fitted, driven through manoeuvres not yet driven; docs/howto/identify.md.
  struct DrivePlan {
    int substeps = 5;               ///< of the integration in a step of commands
    std::size_t draws = 12;         ///< vehicles besides the estimate
    double unknown_share = 0.3;     ///< most error / value, of a parameter that is not told
    double coast_s = 6.0;           ///< after a drive, thrusters off
    double narrower = 0.9;          ///< bounds of depth and tilt: delays, peaks between steps
    double most_turns_per_s = 1.0;  ///< of a plausible vehicle
    double longest_step_s = 0.05;   ///< of the integration on six axes
    double rows_per_window = 8.0;   ///< of a drive on six axes, at least
    // Draws on six axes; docs/measured/applications.md, "Planned drives".
    std::size_t candidates = 32;     ///< per choice
    std::uint64_t longest_hold = 6;  ///< [kManoeuvreStepS]
    double most_holds = 6.0;
    double longest_draw_s = 6.0;
    double softer = 0.85;   ///< amplitude of the next try, of a draw that leaves the bounds
    double softest = 0.05;  ///< amplitude; no softer draw is tried
  } plan;

  int nominal_places = 4000;       ///< in the range of the log: many for 122 terms, and cheap
  double most_supply_ratio = 3.0;  ///< of a supply in use to the voltage of the data sheet
} kTuning;

}  // namespace kelpie::study
