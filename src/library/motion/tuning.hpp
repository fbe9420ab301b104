// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

// The constants that decide the results of diagnosis and identification. Tolerances of solvers
// stand in their sources.
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

/// Chosen by hand, without a recorded measurement, unless a line says otherwise.
inline constexpr struct IdentificationTuning {
  // Weak form (docs/howto/identify.md, "How").
  double half_window_s = 2.5;   ///< [s] half the width of the modulating function
  double stride_s = 0.5;        ///< [s] between windows
  std::size_t window_rows = 5;  ///< [rows] least number in a window
  double spike_factor = 20.0;   ///< [times the 0.9 quantile] a window beyond is dropped

  // Free fit.
  int reweighted = 6;         ///< [rounds] of Huber's weights
  double huber_sigmas = 2.5;  ///< [standard deviations] smaller weight beyond (Huber 1964)
  double most_rho = 0.97;     ///< cap of the AR(1) coefficient in Andrews' bandwidth
  int lag_divisor = 10;       ///< lags at most windows / this

  // Structure and errors.
  double windows_per_term = 5.0;  ///< [windows] least number per term
  double least_inertia = 1e-4;    ///< of M's 2 × 2 block, over the first guess of the yaw inertia
  /// Share of a value, and [rad] of a direction, for the effect of roll and pitch on equations in
  /// the plane: chosen on the simulated Dagon (docs/howto/identify.md, "How", 4).
  double plane_allowance = 0.003;
  double angle_allowance_rad = 0.001;
  double most_unexplained = 0.5;  ///< [share] of the distance from no forces, on six axes
  double most_blur = 0.3;         ///< error of a parameter's effect over the forces of its axis

  // Six axes (docs/howto/identify.md, "Six axes").
  std::array<double, 5> half_windows_s{0.5, 0.25, 1.0, 2.0, 4.0};  ///< [s] tried
  double stride_share = 0.4;  ///< [half a window] between windows
  long pieces = 24;           ///< of the log, whose scores count as independent
  double student90 = 1.714;   ///< quantile 0.95 of Student's t with pieces − 1 degrees of freedom
  double velocity_scale = 0.002;     ///< [share] data sheets of DVLs, ±0.2 %
  double velocity_bias_m_s = 0.001;  ///< [m/s] data sheets of DVLs, ±1 mm/s
  double attitude_bias_rad = 0.001;  ///< [rad] of roll and pitch, by hand
  int curve_steps = 8;               ///< Gauss-Newton steps of the thrust curve, at most
  double least_curve_step = 0.01;    ///< [largest step] a smaller one ends the search
  /// Largest steps and values of lag [s], delay [s], dead band [full command] and exponent of the
  /// supply: by hand.
  std::array<double, 4> most_curve_steps{0.1, 0.1, 0.05, 0.5};
  std::array<double, 4> most_of_curve{5.0, 2.0, 0.5, 3.0};
  double unseen = 10.0;             ///< [share] error of a value that no log tells: by hand
  double least_volts_ratio = 1.02;  ///< of the highest to the lowest supply, to tell an exponent
} kIdentification;

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

/// Of fit_poses(): chosen on the simulated Dagon, seeds 1001 to 1006, where a line says no more.
inline constexpr struct PathTuning {
  double piece_s = 120.0;         ///< [s] length of a piece
  double brief_piece_s = 20.0;    ///< [s] … for the first estimate
  double least_stretch_s = 15.0;  ///< [s] shorter stretches without a gap take no part: by hand
  double longest_hole_s = 1.0;    ///< [s] without a heading, within a stretch: by hand
  std::size_t least_pieces = 2;   ///< by hand
  double longest_step_s = 0.25;   ///< [s] of Runge-Kutta's method: by hand
  double huber_sigmas = 3.0;      ///< [standard deviations] smaller weight beyond: by hand
  double correlated_s = 15.0;     ///< [s] longest lag of the residuals' autocorrelation: by hand
  std::array<double, 2> time_constants_s{2.0, 20.0};  ///< [s] tried first, of each axis
  double first_damping = 1e-3;  ///< [relative] of Levenberg and Marquardt: by hand
  int most_steps = 25;          ///< by hand
  int most_trials = 10;         ///< dampings per step: by hand
  int noise_rounds = 2;         ///< of the weights
  double coarse_gain = 1e-3;    ///< [share of the sum] ends a round of the first estimate
  double fine_gain = 1e-6;      ///< [share of the sum] ends a round
} kPath;

}  // namespace kelpie
