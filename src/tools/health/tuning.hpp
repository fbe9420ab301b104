// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace kelpie::health {

/// Behavioural constants of the health card; howto/diagnosis.md describes them. Chosen by hand
/// except where named.
inline constexpr struct Tuning {
  // Courses.
  double prior_episodes = 2.0;  ///< weight of the told errors against the scatter of the values
  /// [nats] evidence for a change beyond the penalties of BIC, by `kelpie-lab health --noise 3000`
  /// (docs/measured/applications.md): share of series with a report in a year of weekly tests.
  double least_nats = 6.5;
  double kind_nats = 3.0;           ///< [nats] a drift and a step nearer than this: undecided
  double since_nats = 1.353;        ///< [nats] 90 % region of a likelihood with one parameter
  std::size_t fewest_episodes = 5;  ///< of a test
  /// Share of a change, added to its error: what the common fit puts down to other terms. Chosen on
  /// the simulated Dagon: of 12 % more drag 11.4 to 11.9 % show in dives of 20 minutes, of 15 %
  /// more 12.3 to 13.4 % in nine dives of 5 minutes.
  double discrepancy = 0.12;
  double most_correlation = 0.8;  ///< of the residuals of neighbouring episodes

  double bias_rows = 10.0;  ///< whose errors correct a glider's speeds on line

  // Dives.
  double dive_share = 0.2;        ///< of the greatest depth: a dive goes deeper
  double surface_share = 0.1;     ///< of the greatest depth: between dives
  double surface_quantile = 0.1;  ///< of the depths of a log: the depth of the surface
} kTuning;

}  // namespace kelpie::health
