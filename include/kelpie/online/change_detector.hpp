// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "kelpie/core/archive.hpp"
#include "kelpie/online/error_alarm.hpp"
#include "online/tuning.hpp"

namespace kelpie {

/// What a change detector makes of a sample.
enum class Suspicion : std::uint8_t {
  none,       ///< nothing new
  raised,     ///< errors have grown: a challenger should start to learn
  dismissed,  ///< the challenger is no better: the model is poor here, but the vehicle is the same
  confirmed,  ///< the challenger is better by far: what was learned before no longer holds
  withdrawn,  ///< on probation, the model before is better by far: it takes over again
};

/// Tells a changed vehicle from new ground. Errors grow in both cases, so grown errors (ErrorAlarm)
/// only raise a suspicion. Then a challenger, which learns from that moment on and knows nothing of
/// before, is compared with the model one step ahead. On new ground old samples do no harm, and the
/// model keeps up. After a change they do harm, and the model falls behind by more than half a
/// usual misfit per sample, wherever the vehicle goes. Where others learn the vehicle, too, all
/// together have to fall behind the challenger as well, half as far: a vehicle that they still
/// foretell hasn't changed, whatever the model makes of the new ground. Allocates nothing.
class ChangeDetector {
 public:
  /// One sample's errors |y − f(x)|, before it was learned.
  struct Errors {
    double champion = 0.0;
    /// Where there is a challenger, it has a model, and the sample lies where it hasn't been
    /// (kSamePlace).
    std::optional<double> challenger{};
    /// Of all together who learn the vehicle; infinite: there is nobody else.
    double all = std::numeric_limits<double>::infinity();
  };

  /// `misfit`: the model's usual one, the unit of all that follows (> 0; infinite: not known yet).
  /// `t` is the time [s].
  Suspicion inspect(const Errors& errors, double misfit, double t);

  /// Whether there is another model to be compared: a challenger, or on probation the model before.
  bool trying() const { return trying_; }
  bool on_probation() const { return trying_ && probation_; }  ///< The latter.

  /// The vehicle has changed on another axis: half of the evidence is enough for the suspicion at
  /// hand, if there is one.
  void expect_change() { expects_ = trying_ && !probation_; }

  /// Ends a trial.
  void dismiss();

  /// Another model has taken over, one whose usual error is `misfit`, and is on probation: from now
  /// on `challenger` are the errors of the model before. What confirms a change, said of that one,
  /// withdraws it.
  void start_probation(double misfit);

  /// When errors began to grow, of the suspicion raised last [s].
  double since() const { return alarm_.since(); }

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  Suspicion watch(double champion, double misfit, double t);
  Suspicion compare(const Errors& errors);
  void start(double misfit, bool probation);

  bool trying_ = false;
  bool probation_ = false;
  bool expects_ = false;  ///< a change
  ErrorAlarm alarm_{kOnline.change.alarm};
  double lead_ = 0.0;      ///< the challenger's, summed up, in usual misfits
  double over_all_ = 0.0;  ///< the same over all together
  double misfit_ = 0.0;    ///< the usual misfit when the suspicion was raised
  int age_ = 0;            ///< samples the challenger has been shown
};

}  // namespace kelpie
