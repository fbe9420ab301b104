// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace kelpie::health {

/// Rows of one drive of a vehicle, in the order of time.
struct DriveRows {
  std::vector<double> times_s{};
  std::vector<double> inputs{};   ///< rows × inputs: velocities, commands, attitude; finite
  std::vector<double> volts{};    ///< supply of the commands, of each row; empty: unknown
  std::vector<double> density{};  ///< of the water, of each row; empty: unknown
};

/// A part of the equation of motion.
enum class EffectKind : std::uint8_t {
  damping,   ///< all that damps the motion along a velocity, on its axis
  command,   ///< all that a command does, on all axes
  constant,  ///< the constant of the axis of a velocity
};

/// A part of the equation of motion of a certain input.
struct Effect {
  EffectKind kind = EffectKind::damping;
  std::size_t input = 0;
};

/// How much of an effect a drive shows: a factor of the effect over all drives, of a constant the
/// acceleration.
struct EffectFactor {
  double value = 0.0;  ///< NaN: not told
  double error = 0.0;  ///< standard error, for the quantiles of the normal distribution
};

/// The factors of several drives of one vehicle.
struct EffectFactors {
  std::vector<Effect> effects;
  std::vector<std::vector<EffectFactor>> drives;  ///< drives × effects
  std::optional<double> exponent{};               ///< of the supply, where its range tells one
  std::pair<double, double> volts{};              ///< least and greatest
  std::pair<double, double> density{};
};

/// Least number of windows of a drive (fit_planar(): every half second): fewer tell no errors.
inline constexpr std::size_t kFewestFactorWindows = 48;

/// Compares drives:
/// 1. The equation of MotionTerms::open_loop() and a constant, in the weak form of fit_planar(), is
///    fitted to all drives together. Terms of commands go with a power of the supply, in steps of
///    a quarter up to 3, where the supply varies by 2 %; terms of damping and of commands go with
///    the density.
/// 2. In each drive, the factors of all effects are fitted jointly, by Huber's least squares; the
///    rest of the equation (Coriolis forces, restoring forces, lift) is held.
/// 3. Errors: a sandwich from 24 pieces of the drive, Student's t (Liang & Zeger 1986).
/// A factor with a standard error above 0.3 is not told, and so are all factors of a drive with
/// fewer than kFewestFactorWindows windows. `names`: of the inputs, for the attitude; `gap_s`: a
/// longer step ends a stretch. Requires velocities among the inputs. Throws InputError where all
/// drives together have fewer than five windows per term. Cost: of fit_freely() with at most 20,000
/// windows and 65 terms, 13 times with a supply. Allocates. Deterministic.
EffectFactors fit_factors(std::span<const DriveRows> drives, std::span<const std::string> names,
                          std::span<const std::size_t> velocities, double gap_s);

}  // namespace kelpie::health
