// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "kelpie/core/archive.hpp"
#include "kelpie/online/error_alarm.hpp"

namespace kelpie {

/// What a change detector makes of a sample.
enum class Suspicion : std::uint8_t {
  none,       ///< nothing new
  raised,     ///< errors have grown: a challenger should start to learn
  dismissed,  ///< the challenger is no better: the model is poor here, but the vehicle is the same
  confirmed,  ///< the challenger is better by far: what was learned before no longer holds
};

/// Tells a changed vehicle from new ground. Errors grow in both cases, so that they grow
/// (ErrorAlarm) only raises a suspicion. Then a challenger that learns from that moment on, and
/// knows nothing of before, is compared with the model one step ahead: on new ground old samples do
/// no harm, and the model keeps up; after a change they do, and it falls behind by more than half a
/// usual error per sample, wherever the vehicle goes. Allocates nothing.
class ChangeDetector {
 public:
  /// One sample's errors before it was learned, |y − f(x)|: the model's; the challenger's where
  /// there is one, it has a model, and the sample lies where it hasn't been (one place counts once,
  /// else a vehicle at rest would make its case all by itself); and the model's usual error (> 0;
  /// infinite: not known yet). `t` is the time [s].
  Suspicion judge(double champion, std::optional<double> challenger, double usual, double t);

  /// Whether a challenger is being tried.
  bool trying() const { return trying_; }

  /// Ends a trial: the model was replaced otherwise.
  void dismiss();

  /// When errors began to grow, of the suspicion raised last [s].
  double since() const { return alarm_.since(); }

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  Suspicion watch(double champion, double usual, double t);
  Suspicion compare(double champion, std::optional<double> challenger);

  bool trying_ = false;
  ErrorAlarm alarm_{20.0};  ///< at least seven bad samples in a row
  double lead_ = 0.0;       ///< the challenger's, summed up, in usual errors
  double usual_ = 0.0;      ///< the usual error when the suspicion was raised
  int age_ = 0;             ///< samples the challenger has been shown
};

}  // namespace kelpie
