// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
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

/// Of fit_factors(); by hand.
inline constexpr struct FactorTuning {
  long most_windows = 20000;    ///< [windows] of the common fit, spread over all drives
  long windows_per_term = 5;    ///< [windows] least number per term
  std::size_t most_terms = 64;  ///< of a drive
  double most_error = 0.3;      ///< of a factor; a factor with a larger error is not told
  double most_exponent = 3.0;   ///< of the supply
  double exponent_step = 0.25;  ///< of the search
} kFactors;

/// Of fit_glide(); by hand, unless a line says otherwise.
inline constexpr struct GlideTuning {
  double reference_density = 1025.0;  ///< [kg/m³]
  /// Over the slope of the lift: Slocum gliders (Merckelbach et al. 2010), and SeaExplorers within
  /// a factor of two.
  double induced = 1.5;
  double least_slope = 0.05;     ///< of tan γ: no attack grows beyond all bounds
  double most_attack_rad = 0.5;  ///< [rad] a stalled wing has no such lift
  int attack_rounds = 10;        ///< halve the error each
  int rounds = 25;               ///< of the search
  double least_gain = 1e-5;      ///< of the squares: a smaller gain ends the search
  std::array<double, 6> step{1.0, 1e-3, 1e-1, 1.0, 1e-4, 0.1};  ///< of a derivative (GlidePlace)
} kGlide;

}  // namespace kelpie::health
