// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "kelpie/core/archive.hpp"
#include "learner/error_alarm.hpp"
#include "learner/tuning.hpp"

namespace kelpie {

/// The result of one sample for a change detector.
enum class Suspicion : std::uint8_t {
  none,       ///< no event
  raised,     ///< errors have grown: a challenger has to start learning
  dismissed,  ///< the challenger is not better: a poor model of the same vehicle
  confirmed,  ///< the challenger is much better: older samples are invalid
  withdrawn,  ///< on probation the former model is much better: it takes over again
};

/// Distinguishes a changed vehicle from a new region of the input space. Errors grow in both cases;
/// grown errors (ErrorAlarm) therefore only raise a suspicion. A challenger, which learns from this
/// moment and without older samples, is then compared with the model one step ahead. In a new
/// region old samples are still valid, and the model adapts as fast as the challenger. After a
/// change old samples are wrong, and the challenger is better by more than half a usual misfit per
/// sample. The challenger has to be ahead of two more, by half as much: of the committee, since a
/// vehicle with small errors of the committee has not changed; and of the model plus the mean error
/// since the suspicion, since a slow disturbance or the offset of a sensor is no change of the
/// vehicle, and a model without a past follows both. Allocates nothing.
class ChangeDetector {
 public:
  /// The errors y − f(x) of one sample before learning.
  struct Errors {
    double champion = 0.0;
    /// Given if the challenger has a model and the sample's place is new to the challenger
    /// (OnlineTuning::Memory::same_place).
    std::optional<double> challenger{};
    /// Of the committee; infinite without a committee.
    double all = std::numeric_limits<double>::infinity();
  };

  /// Processes one sample at the time `t` [s]. `misfit`: the model's usual misfit, the unit of the
  /// comparison (> 0; infinite: unknown).
  Suspicion inspect(const Errors& errors, double misfit, double t);

  /// Whether a comparison is under way: with a challenger, or on probation with the former model.
  bool trying() const { return trying_; }
  bool on_probation() const { return trying_ && probation_; }  ///< The second case.

  /// Reports a change on another axis: halves the evidence required by a present suspicion.
  void expect_change() { expects_ = trying_ && !probation_; }

  /// Ends a comparison.
  void dismiss();

  /// Starts the probation of a model with the usual error `misfit` that has taken over.
  /// `challenger` then holds the errors of the former model, and evidence for the former model
  /// withdraws the change.
  void start_probation(double misfit);

  /// Start of the grown errors of the last suspicion [s].
  double since() const { return alarm_.since(); }

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  Suspicion watch(double champion, double misfit, double t);
  Suspicion compare(const Errors& errors);
  void count(const Errors& errors);
  void start(double misfit, bool probation);

  bool trying_ = false;
  bool probation_ = false;
  bool expects_ = false;  ///< of a change: half of the evidence is enough
  ErrorAlarm alarm_{kOnline.change.alarm};
  double lead_ = 0.0;         ///< sum of the challenger's advantages [usual misfits]
  double over_all_ = 0.0;     ///< the same over the committee
  double over_offset_ = 0.0;  ///< the same over the model plus its mean error
  double mean_error_ = 0.0;   ///< of the model since the suspicion, steps clipped
  double misfit_ = 0.0;       ///< the usual misfit at the suspicion
  int age_ = 0;               ///< samples of the comparison
};

}  // namespace kelpie
