// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace kelpie::report {

/// Thresholds of verdicts and limits of figures. Chosen by hand; no measurement recorded.
inline constexpr struct Tuning {
  double first_window_s = 60.0;      ///< of a figure of samples, at first
  double first_window_rows = 120;    ///< of it, at least
  double before_change = 0.25;       ///< share of that stretch before a change in it
  double lowest_r2 = -0.2;           ///< R² below is drawn at the edge of a figure
  double shown_below = 4.0;          ///< of a comparison, below the median, per range above it
  double clear_r2 = 0.01;            ///< smallest difference of R² that a recommendation mentions
  double clear_one_step_r2 = 0.001;  ///< the same one step ahead, where every R² is close to 1
  double very_good_r2 = 0.9;         ///< words of a verdict
  double good_r2 = 0.7;
  double fair_r2 = 0.4;
  double least_memories =
      10.0;  ///< of the velocities in held-out stretches, for a word beyond fair
  std::size_t longest_log = 60;     ///< characters of a log's name in a verdict
  double told_horizon_s = 10.0;     ///< the longest horizon that a verdict tells in words
  std::ptrdiff_t rows_since = 500;  ///< after a change, that are worth learning alone
  std::size_t judging_rows = 100;   ///< held-out rows since a change that judge the model alone
  double better_since = 0.05;       ///< of R², on these rows: the rows of before mislead
  std::size_t most_changes = 6;     ///< lines about changes of the vehicle in a verdict
  double told_skipped = 0.05;       ///< share of the rows: more left out are told
  double told_thrust = 1.0;         ///< widest interval of a thruster's share that tells the share
  double same_change_s = 15.0;      ///< between two beginnings of one change [s]
  double clear_gain = 0.05;         ///< of R², by the commands, in the first look at a log
  double structure_loss = 0.05;     ///< of R²: a larger loss to untied terms is a warning
  double poor_r2 = 0.5;             ///< R² of an identified axis below is a warning
  /// χ² over its expectation of an identified vehicle; above, its intervals are too narrow.
  /// Simulated vehicles have 1.6 to 3.7, with a battery that sags 7.9, with a dead band 6.9.
  double high_misfit = 5.0;
  double high_correlation = 0.9;  ///< of the errors of two parameters; listed from here on
} kTuning;

}  // namespace kelpie::report
