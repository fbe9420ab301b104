// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace kelpie::fleet {

/// Behavioural constants of a study; howto/studies.md describes them. Chosen by hand except where
/// named; no constant changes a learned number.
inline constexpr struct Tuning {
  /// Samples: the time of a run is taken to be proportional to this number + `buffer`. Measured
  /// by `kelpie study` over buffers of 30 to 2,000: 85 on a ground vehicle of 24,000 rows, 130 on
  /// Dagon and on simulated dives, where the buffer does not fill and larger ones cost no more.
  double free_buffer = 100.0;
  std::size_t advance_every = 64;      ///< samples between two reports of a run
  double clear_difference = 0.01;      ///< R² beyond which a learner counts as better
  double trend_level = 0.05;           ///< chance below which a trend stands out
  std::size_t fewest_for_trend = 10;   ///< missions; from ten on, S of Mann and Kendall is normal
  std::size_t worst_runs = 50;         ///< length of the lists of worst runs; display alone
  std::uint64_t most_seeds = 1000;     ///< of random splits
  std::size_t most_parts = 1'000'000;  ///< of --part
} kTuning;

}  // namespace kelpie::fleet
