// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "kelpie/core/archive.hpp"
#include "kelpie/online/robust_scale.hpp"

namespace kelpie {

/// What a model can't know (waves, a current, a tether, its own faults) is still there a moment
/// later. Of predictions f and what was measured, y, this learns what to add to the next one:
///
///     d = θ₁ e₋₁ + θ₂ e₋₂ + θ₃ (y₋₁ − y₋₂) + θ₄ (f − f₋₁),   e = y − f,
///
/// θ by recursive least squares that forget no more than a sample brings. For later samples the
/// last error fades: d = ρʰ e₋₁ after h usual steps, ρ its autocorrelation at one step.
///
/// Bounded: f + d lies within 3 usual errors of the range of f, y₋₁ and 2 y₋₁ − y₋₂, and d never
/// takes a prediction further out of the range of the targets seen.
/// Robust: a target more than 10 usual errors away is learned only if the next one confirms it;
/// until then it counts as much as such targets were confirmed before. No sample weighs more than
/// a hundred usual ones. After a pause the past is stale, and learning waits for two samples in a
/// row.
///
/// In the unit of the target. Allocates nothing.
class Disturbance {
 public:
  /// What to add to the `predicted` value of the next sample; 0 before there are eight.
  double next(double predicted) const;

  /// The same of a sample `seconds` after the last: next() where it is that, else the fading error.
  double ahead(double predicted, double seconds) const;

  /// The same of a sample at the time t [s].
  double at(double predicted, double t) const { return ahead(predicted, t - time_s_); }

  /// Whether a sample `seconds` after the last is the next one: up to one and a half usual steps.
  bool is_next(double seconds) const;

  /// Learns from one sample at the time t [s], never decreasing, and from what the model had
  /// predicted of it. Requires finite values. Cost O(1), with two medians of 256 values at every
  /// 8th sample.
  void observe(double predicted, double y, double t);

  /// ρ, 0 to 1: the autocorrelation of the model's errors from one sample to the next.
  double autocorrelation() const;

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  static constexpr std::size_t kLeast = 8;     // samples before anything is said
  static constexpr std::size_t kMeasured = 8;  // samples between two looks at usual errors

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
  double rows_ = 0.0;    ///< learned and not forgotten

  Sample last_;
  Sample before_;
  double time_s_ = 0.0;
  double usual_step_s_ = 0.0;
  std::int64_t run_ = 0;  ///< samples one after the other without a pause

  bool suspect_ = false;  ///< whether the last target is far from what was expected
  bool pending_ = false;  ///< … and is to be learned once it is confirmed
  double expected_ = 0.0;
  Column suspect_phi_{};
  double trust_ = 0.5;  ///< share of such targets that were confirmed
  double judged_ = 2.0;

  double low_ = std::numeric_limits<double>::infinity();  ///< range of the targets believed
  double high_ = -std::numeric_limits<double>::infinity();
  RobustScale usual_{kLeast, kMeasured};  ///< errors of what is said with the disturbance
  RobustScale plain_{kLeast, kMeasured};  ///< errors of the model alone
};

}  // namespace kelpie
