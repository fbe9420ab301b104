// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

// The constants that decide the results of diagnosis and authority. Tolerances of solvers stand in
// their sources.
namespace kelpie {

/// Chosen on the simulated Dagon of `kelpie-lab diagnose`, seeds 1001 to 1006, unless a line says
/// otherwise; docs/howto/diagnosis.md measures seeds 1 to 20. A block takes 2.5 s at 4 Hz.
inline constexpr struct DiagnosisTuning {
  // Blocks of rows.
  double block_rows = 6.0;        ///< [rows] least size of a block: a row per window
  double block_s = 2.25;          ///< [s] least time from the first to the last row
  double outlier_sigmas = 6.0;    ///< [standard deviations] a single row beyond is dropped
  double reference_s = 240.0;     ///< [s] least length of the reference (from 60, 120, 240),
  double reference_rows = 960.0;  ///< [rows] or this number of rows,
  double rows_per_term = 10.0;    ///< [rows] and at least so many: by hand
  double memory_s = 3600.0;       ///< [s] of the reference
  double rate_kept = 0.99;        ///< of the greatest rate, per block: by hand

  // Detection.
  std::array<std::size_t, 6> windows{2, 4, 8, 12, 18, 24};  ///< [blocks]
  double alarm_nats = 40.0;                                 ///< evidence of an alarm,
  double alarm_nats_per_size = 2.0;                         ///< plus this for each free size
  double usual_blocks = 400.0;   ///< [blocks] memory of the usual scatter
  double usual_limit = 9.0;      ///< [times the usual scatter] cap of a new value
  double later_cut_gain = 1.01;  ///< [ratio] an earlier cut needs this much more evidence
  std::size_t guard_blocks = 2;  ///< [blocks] skipped around a cut: 5 s at 4 Hz
  double excited_share = 1e-2;   ///< [share of the reference's excitation] ridge of the refit

  // Naming.
  std::size_t first_blocks = 4;     ///< [blocks] before the first name: 10 s at 4 Hz
  std::size_t chance_blocks = 12;   ///< [blocks] after which an unexplained alarm is withdrawn
  std::size_t settled_blocks = 48;  ///< [blocks] after which a finding is final: 2 minutes at 4 Hz
  double named_margin_nats = 5.0;   ///< over the second-best cause: 150 times as likely
  double least_nats = 30.0;         ///< over no change
  double least_share = 0.03;        ///< of thrust, drag, inertia, scale: smaller changes are silent
  double least_explained = 0.6;     ///< share of the unrestricted refit; below: no known cause
  double pair_dispersion = 2.0;     ///< [times the usual scatter] above, pairs are tested
  /// Share of the unrestricted refit; above, no load is the second cause, since its many sizes
  /// explain the model error of the first: by hand.
  double alone_explained = 0.95;
  double pair_share = 0.75;  ///< of the unexplained rest that the second cause explains
  double pair_nats = 12.0;   ///< least gain of a pair over a single cause
  /// Model error as a share of the change, for factors; and for added accelerations and
  /// velocities. Filters on the accelerations weaken the equations as a whole, visible in the
  /// latter only.
  double discrepancy = 0.004;
  double added_discrepancy = 0.0125;
  double most_inertia = 3.0;   ///< [ratio] of a load that comes, its inverse of a load that goes
  double sure_errors = 2.0;    ///< [standard errors] of a share of a load that counts: by hand
  double dead_share = 0.2;     ///< of thrust; below, the next change is no factor: by hand
  double kept_named = 0.5;     ///< weight of the reference after a named change
  double kept_unnamed = 0.02;  ///< weight after another change

  // Frozen signals.
  std::size_t frozen_rows = 20;   ///< [rows] least number of repeats
  double frozen_s = 5.0;          ///< [s] least time
  std::size_t frozen_factor = 4;  ///< [times the longest run so far]
} kDiagnosis;

/// Of Authority; chosen by hand.
inline constexpr struct AuthorityTuning {
  double ridge = 1e-6;           ///< ρ: prefers little thrust where many commands do
  double reached = 2e-3;         ///< of the nominal range: a wanted acceleration counts as reached
  double near_singular = 0.1;    ///< of the nominal least singular value
  double dead = 0.03;            ///< share of thrust, below which a thruster gets no command
  double fastest_current = 5.0;  ///< [unit of the log's velocities] end of the search
  int bisections = 40;           ///< to rounding of a millionth of a millionth
} kAuthority;

}  // namespace kelpie
