// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "kelpie/core/archive.hpp"
#include "svr/robust_scale.hpp"

namespace kelpie {

/// The present disturbance. Errors that the model cannot explain (waves, current, tether, errors of
/// the model) persist for some samples. From predictions f and measured values y this class learns
/// the correction d of the next prediction:
///
///     d = θ₁ e₋₁ + θ₂ e₋₂ + θ₃ (y₋₁ − y₋₂) + θ₄ (f − f₋₁),   e = y − f,
///
/// with θ by recursive least squares whose forgetting is limited by the information of each sample.
/// For later samples the last error decays: d = ρʰ e₋₁ after h usual steps, with the
/// autocorrelation ρ at one step.
///
/// Bounded: f + d lies within 3 usual errors of the range of f, y₋₁ and 2 y₋₁ − y₋₂, and d moves no
/// prediction further out of the range of the targets seen than a quarter of the width.
/// Robust: a target at a distance of more than 10 usual errors is a suspect, learned only after
/// confirmation by the next target. Until then the suspect is weighted by the fraction of earlier
/// suspects that were confirmed. No sample weighs more than a hundred usual samples. After a pause
/// learning waits for two consecutive samples.
///
/// Units: as the target. Allocates nothing.
class Disturbance {
 public:
  /// Correction of the `predicted` value of the next sample; 0 for the first eight samples.
  double next(double predicted) const;

  /// Correction of a sample `seconds` after the last: next() if is_next(), else the decaying error.
  double ahead(double predicted, double seconds) const;

  /// ahead() for a sample at the time t [s].
  double at(double predicted, double t) const { return ahead(predicted, t - time_s_); }

  /// Whether a sample `seconds` after the last is the next sample: up to 1.5 usual steps.
  bool is_next(double seconds) const;

  /// Learns from one sample at the time t [s], never decreasing, and the model's prediction of the
  /// sample. Requires finite values. Cost O(1), with two medians of 256 values at every
  /// 8th sample.
  void observe(double predicted, double y, double t);

  /// ρ, 0 to 1: the autocorrelation of the model's errors from one sample to the next.
  double autocorrelation() const;

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  static constexpr std::size_t kLeast = 8;     // samples before the first correction
  static constexpr std::size_t kMeasured = 8;  // samples between two medians

  using Column = std::array<double, 4>;

  struct Sample {
    double y = 0.0;
    double predicted = 0.0;
  };

  bool known() const { return usual_.count() >= kLeast; }
  double usual_steps(double seconds) const;
  double trusted_target() const;
  double last_error() const { return trusted_target() - last_.predicted; }
  Column features(double predicted) const;
  double in_range(double predicted, double value) const;
  double bounded(double y, double predicted) const;
  void decide_suspect(double y, bool follows);
  void score(const Sample& sample, double said, bool follows);
  void learn(const Column& phi, double error);
  void learn_step(double seconds);
  void widen_range(double y);

  std::array<double, 16> information_{};  ///< Σ w φφᵀ
  Column moment_{};                       ///< Σ w φ e
  Column theta_{};
  double energy_ = 0.0;  ///< Σ w (|φ|² + e²)
  double rows_ = 0.0;    ///< effective number of samples

  Sample last_;
  Sample before_;
  double time_s_ = 0.0;
  double usual_step_s_ = 0.0;
  std::int64_t run_ = 0;  ///< consecutive samples without a pause

  bool suspect_ = false;  ///< the last target is a suspect
  bool pending_ = false;  ///< the suspect awaits confirmation
  double expected_ = 0.0;
  Column suspect_phi_{};
  double trust_ = 0.5;  ///< fraction of confirmed suspects
  double judged_ = 2.0;

  double low_ = std::numeric_limits<double>::infinity();  ///< range of the trusted targets
  double high_ = -std::numeric_limits<double>::infinity();
  RobustScale usual_{kLeast, kMeasured};  ///< errors of corrected predictions
  RobustScale plain_{kLeast, kMeasured};  ///< errors of the model
};

}  // namespace kelpie
