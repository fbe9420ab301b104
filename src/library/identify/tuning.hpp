// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

// The constants that decide the results of identification. Tolerances of solvers stand in their
// sources.
namespace kelpie {

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
