// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace kelpie {

/// The behavioural constants of the paper's learner and of the solvers of its dual problem: chosen
/// by hand, without a recorded measurement, where no source is named. Work is counted in visited
/// numbers.
struct SvrTuning {
  /// PathSolver.
  std::size_t renewed_residuals = 4;  ///< computed afresh in every solve
  std::uint64_t factor_renewal = 8;   ///< solves between two renewals of a row of the factor
  int polish_rounds = 20;             ///< corrections of the free samples per solve
  int astray_steps = 1000;            ///< steps of a path before the fallback to SMO,
  int astray_steps_per_sample = 20;   ///< with so many more per sample
  double slack_of_targets = 1e-10;    ///< violation treated as rounding, of |y| + ε
  double slack_of_weights = 1e-15;    ///< and of Σ|β|

  /// PathMove.
  double still = 1e-13;             ///< rate treated as rounding, of the size of the move
  std::size_t least_watched = 128;  ///< smallest watch list [samples]
  std::size_t watched_part = 8;     ///< capacity divided by the length of the watch list
  double nearness = 0.1;            ///< first distance from an edge of watched samples
  double nearness_shrinks = 0.8;    ///< per path with a full watch list
  double nearness_grows = 1.25;     ///< per path with a watch list less than half full

  /// Work of the solvers; docs/measured/performance.md has the time of a number.
  std::size_t work_aside = 3'000;    ///< loops over all samples, per move
  std::size_t work_slice = 300'000;  ///< slice of a restart
  std::size_t work_smo_step = 6;     ///< per sample
  std::size_t work_path_step = 40;   ///< per sample

  /// FreeSet, SmoSolver.
  double least_pivot = 1e-12;    ///< of a squared pivot, relative to K_ii
  double maybe_rounding = 1e-9;  ///< KKT gap below which rounding is considered

  /// OnlineSvr and its nodes.
  double most_self = 1e6;  ///< largest κ(x, x): above it rounding hides the other kernel parts
  int most_waiting = 8;    ///< samples of an unfinished update, the largest age of the model
  std::size_t slice_of_rows = 25'000;  ///< kernel elements per slice: by the time of an update
  std::size_t element_work = 30;       ///< of a kernel element [numbers], measured/performance.md
  std::size_t outlier_least = 64;      ///< errors before s is known: by hand
  std::size_t outlier_every = 8;       ///< errors between two medians: by hand
  std::size_t quartiles_least = 4;     ///< support vectors of `iqr`
};

inline constexpr SvrTuning kSvr{};

}  // namespace kelpie
