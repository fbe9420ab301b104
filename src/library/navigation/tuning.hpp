// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace kelpie {

/// The behavioural constants of the room navigation, each with unit and source. "By hand": chosen
/// by hand; no measurement recorded.
inline constexpr struct NavigationTuning {
  /// Choice between hypotheses of the current, and cuts in a log (navigation/dead_reckoning.hpp).
  struct Choice {
    double least_noise = 1e-12;    ///< variance of a measurement, against singular matrices
    double least_widening = 0.01;  ///< of velocities, where practice had no error at all; by hand
    int least_scored = 5;          ///< practised outages before a choice (docs/method/open_loop.md)
    double better = 0.7;           ///< of the error of a simpler hypothesis (method/open_loop.md)
    double cut = 100.0;            ///< squared deviations of a cut in the log; by hand
    double apart_memory = 0.01;    ///< weight of the last sample in the share of cuts; by hand
    double most_apart = 0.05;      ///< share of cuts, beyond which the model is at fault; by hand
  } choice;

  /// Practised outages (navigation/practice.hpp).
  struct Practice {
    double gain = 0.3;           ///< of the logarithm of the noise factor, per outage; by hand
    double share = 0.05;         ///< weight of the last outage in the mean error; by hand
    double gap = 0.25;           ///< of an outage: longest step with known commands; by hand
    double early = 0.25;         ///< of an outage: age at which it is scored, too; by hand
    double longer = 3.0;         ///< outages, of which one in `every` is so long; by hand
    int every = 2;               ///< outages; by hand
    std::size_t outages = 24;    ///< that count, as stretches do in rollouts (method/open_loop.md)
    std::size_t least = 3;       ///< outages of an age, before they widen the ellipse; by hand
    double least_factor = 0.01;  ///< of the noise factor; by hand
    double most_factor = 100.0;  ///< of the noise factor; by hand
  } practice;

  /// Velocities that a sensor didn't measure (navigation/velocity_check.hpp); by hand.
  struct Check {
    double frozen_s = 0.5;        ///< s, least time of constant values that aren't 0
    double usual_hold = 3.0;      ///< times the usual time between two changes
    double hold_memory = 0.1;     ///< weight of the last change in that time
    double rest_s = 3.0;          ///< s, of constant values at rest, until they count
    double sigmas = 3.0;          ///< of an estimate, an acceleration or noise: a contradiction
    double most_apart_s = 1.0;    ///< s, between velocities at the start
    double longest_gap_s = 2.0;   ///< s, without a measurement, until practice ends
    std::size_t least_equal = 4;  ///< equal values of one velocity while others change
  } check;

  /// The Kalman filter (navigation/velocity_filter.hpp).
  struct Filter {
    double least_time_s = 0.5;  ///< s, of an error: two steps of a quarter second
    double most_time_s = 2.0;   ///< s, of an error; docs/method/open_loop.md
    double furthest = 9.0;      ///< squared deviations of a measurement: 3 standard deviations
    double most_step = 3.0;     ///< standard deviations that a measurement moves a velocity
    int most_doubts = 3;        ///< measurements beyond, before the filter accepts them; by hand
    double agreeing = 0.5;      ///< of a doubtful error: two such measurements agree; by hand
    double sure = 2.0;          ///< standard deviations of an error found so; by hand
  } filter;
} kNavigationTuning;

}  // namespace kelpie
