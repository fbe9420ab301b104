// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace kelpie::health {

/// Rows of a glider's log, in the order of time. Empty columns: not logged.
struct GlideRows {
  std::vector<double> times_s{};
  std::vector<double> pitch_rad{};   ///< nose up positive
  std::vector<double> ballast_ml{};  ///< displaced volume of the pump
  std::vector<double> depth_m{};
  std::vector<double> density{};  ///< of the water [kg/m³]; may be empty
  std::vector<double> sinking{};  ///< vertical speed, down positive [m/s]; NaN: none
  std::vector<double> speed{};    ///< through the water [m/s]; NaN: none
  double surface_m = 0.0;         ///< depth where the glider floats

  std::size_t rows() const { return times_s.size(); }
};

/// Places of a glider's parameters.
struct GlidePlace {
  static constexpr std::size_t buoyancy = 0;  ///< net buoyancy at ballast 0 and the surface [ml]
  static constexpr std::size_t depth = 1;     ///< growth of the net buoyancy [ml/m]
  static constexpr std::size_t density = 2;   ///< the same, with the density [ml m³/kg]
  static constexpr std::size_t drag = 3;  ///< net buoyancy along the path over speed² [ml s²/m²]
  static constexpr std::size_t attack = 4;  ///< drag over the slope of the lift, of no attack
  static constexpr std::size_t lag = 5;     ///< time constant of the speeds [s]
  static constexpr std::size_t count = 6;
};
using GlideParameters = std::array<double, GlidePlace::count>;

/// Speeds of a glider, row by row.
struct GlideMotion {
  std::vector<double> sinking;  ///< m/s, down positive
  std::vector<double> speed;    ///< through the water, m/s
};

/// Steady gliding (Merckelbach, Smeed & Griffiths 2010), through a lag of first order: with the net
/// buoyancy B in ml of water and the angle of the path γ = θ + α,
///   B = ballast + buoyancy + depth · z + density · (ρ − 1025),   drag · U² = B sin γ,
///   α = (attack + 1.5 α²) / tan γ,   sinking = −U sin γ.
/// At the surface the glider floats: no rise within a step goes above `surface_m`. Requires pitch,
/// ballast, depth of every row. Allocates.
GlideMotion glide(const GlideRows& rows, const GlideParameters& parameters);

/// A glider identified from rows.
struct GlideFit {
  GlideParameters parameters{};
  GlideParameters errors{};  ///< standard errors; 0: held
  std::size_t rows = 0;      ///< with a speed
};

/// Start of a fit: neutral at ballast 0, a speed of 0.4 m/s at 200 ml and a path of 30°.
GlideParameters first_glide();

/// Fits the parameters `free` to the measured speeds of all `parts` by Gauss-Newton with Huber's
/// weights, from `start`; the others are held. Errors: a sandwich from 24 pieces of all rows, with
/// Student's t. Requires more rows with a speed than 48. Throws InputError on fewer. Allocates.
GlideFit fit_glide(std::span<const GlideRows> parts, const GlideParameters& start,
                   std::span<const std::size_t> free);

/// The slope of y over x through 0 with Huber's weights, and the error by the same sandwich. NaN
/// where fewer than 48 pairs are given, or x is 0 throughout. Requires equal sizes. Allocates.
std::pair<double, double> fit_slope(std::span<const double> x, std::span<const double> y);

}  // namespace kelpie::health
