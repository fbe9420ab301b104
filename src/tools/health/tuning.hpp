// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace kelpie::health {

/// Behavioural constants of the health card; howto/diagnosis.md describes them. Chosen by hand
/// except where named.
inline constexpr struct Tuning {
  // Courses.
  double prior_episodes = 2.0;  ///< weight of the told errors against the scatter of the values
  /// [nats] evidence for a change beyond the penalties of BIC. `kelpie-lab health --null 20000`:
  /// share of series with a report within a year of weekly tests.
  double least_nats = 6.5;
  double kind_nats = 3.0;           ///< [nats] a drift and a step nearer than this: undecided
  double since_nats = 1.353;        ///< [nats] 90 % region of a likelihood with one parameter
  std::size_t fewest_episodes = 5;  ///< of a test
  double most_correlation = 0.8;    ///< of the residuals of neighbouring episodes

  // Factors.
  long pieces = 24;                 ///< of an episode, whose scores count as independent
  double student = 1.043;           ///< 0.95 quantile of Student's t, 23 degrees, over the normal's
  long most_windows = 20000;        ///< of the common fit, spread over all episodes
  std::size_t most_terms = 64;      ///< of the equation of motion
  double most_error = 0.3;          ///< standard error of a factor; a larger one: not told
  double least_volts_ratio = 1.02;  ///< of the highest to the lowest supply, to tell an exponent
  double most_exponent = 3.0;       ///< of the supply's voltage
  double exponent_step = 0.25;

  // Dives.
  double dive_share = 0.2;     ///< of the greatest depth: a dive goes deeper
  double surface_share = 0.1;  ///< of the greatest depth: between dives
} kTuning;

inline constexpr double kNormal90 = 1.645;  ///< half a 90 % interval over the standard error

}  // namespace kelpie::health
