// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kelpie/core/archive.hpp"

namespace kelpie {

/// The size of a cause, or of several alike, without any other.
struct LoneCause {
  double size = 0.0;
  double variance = 0.0;
  double likelihood = 0.0;  ///< over no change [nats]

  void visit(Archive& archive);  ///< core/archive.hpp
};

/// Causes alike, counted beside each cause: drag of all axes, inertia of all axes, all commands.
inline constexpr std::size_t kCausesOfMany = 3;

/// The value of one axis at one row, and the effect of every cause on this value.
struct CauseEffects {
  double value = 0.0;            ///< Θ₀ᵀφ
  std::vector<double> of_cause;  ///< ∂value/∂s, in the order of ChangeStart::lone
  std::vector<double> square;    ///< of each command: the part in higher powers of the command
};

/// The effect of a command on rows, as sums over rows and axes: of the command's terms in the first
/// power of the command L, and in the second (and higher) Q.
struct CommandEffect {
  double ll = 0.0;
  double lq = 0.0;
  double qq = 0.0;

  /// Adds a row of one axis with this weight.
  void add(const CauseEffects& effects, std::size_t command, double weight);

  /// The factor g of the command with (g - 1) L + (g² - 1) Q ≈ size (L + Q).
  double gain(double size) const;

  void visit(Archive& archive);  ///< core/archive.hpp
};

/// A start of the ChangeMonitor: the hypothesis that the vehicle has changed at one moment, with
/// the size of every cause. Causes are the commands, then the drag of every axis, then the inertia
/// of every axis. Memory: the constructor's.
struct ChangeStart {
  /// Requires 1 axis or more, and of coefficients some per axis.
  ChangeStart(std::size_t commands, std::size_t axes, std::size_t coefficients);

  /// Begins at t [s], without knowledge of sizes; Θ₀, scatter and tau stay, and are to be known.
  void begin(double t, double life);

  /// Every cause may have a part in the change.
  void expect_all_causes();

  /// One cause alone is believed, with this size and variance.
  void expect_cause(std::size_t cause, double believed, double variance);

  /// Adds the target y of one axis at one row: the evidence, then a Kalman update of all sizes.
  /// `without`: the error of the vehicle without a change. `spread`: variance of an error over the
  /// variance of the noise.
  void observe(std::size_t axis, const CauseEffects& effects, double y, double without,
               double spread);

  /// The mean of the sizes over all hypotheses of this start, weighted by likelihood.
  void mix_sizes(std::span<double> sizes) const;

  void visit(Archive& archive);  ///< core/archive.hpp

  bool alive = false;
  double begun_s = 0.0;
  double life_s = 0.0;
  double evidence = 0.0;           ///< over the vehicle without a change [nats]
  double over_constant = 0.0;      ///< the same over constant errors alone, never below 0
  double samples = 0.0;            ///< independent samples so far
  double peak = 0.0;               ///< largest evidence after a row [nats]
  double likelihood = 0.0;         ///< of all sizes together, over no change [nats]
  std::vector<double> theta;       ///< Θ₀, axis after axis
  std::vector<double> size;        ///< mean of s
  std::vector<double> covariance;  ///< of s
  std::vector<LoneCause> lone;     ///< each cause, then kCausesOfMany
  /// The error of each axis that has been constant for some time, as the only cause: a disturbance,
  /// or the model's own error where the vehicle holds its speed.
  std::vector<LoneCause> constant;
  std::vector<double> scatter;        ///< usual error of each axis
  std::vector<double> tau;            ///< rows per independent sample of each axis
  std::vector<CommandEffect> effect;  ///< of each command

 private:
  std::span<double> sizes_of(std::size_t cause, std::span<double> sizes) const;
  void observe_lone(std::size_t axis, const CauseEffects& effects, double error, double noise,
                    double unchanged);
  LoneCause unknown_constant(std::size_t axis) const;
  double constant_log_density(std::size_t axis, double error, double noise, double unchanged);

  std::vector<double> gain_;  ///< scratch
};

/// Weight of an error: errors beyond 2.5 of their standard deviations count less.
double robust_weight(double error, double variance);

}  // namespace kelpie
