// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/recent_values.hpp"
#include "kelpie/core/archive.hpp"
#include "kelpie/model/open_loop.hpp"

namespace kelpie {

/// How far rollouts of two models, A and B, and velocity held are off, by practice: while samples
/// come, both models are integrated in open loop from a measured velocity for up to a minute, and
/// their errors are scored at kPractisedAges; then from the next sample. One stretch at a time, so
/// that the cost is one evaluation of each model per step (Adams-Bashforth of second order). A
/// sample tells before it is learned, but the models learn on during a stretch. The last 24
/// stretches count: what a young model did says nothing of today's. In a sum of squares a stretch
/// has the weight 1/(e² + median e² of the newer half), so that single stretches don't decide.
/// Update allocates nothing.
class OpenLoopPractice {
 public:
  /// `states`: the inputs that are integrated, and `attitude` with them.
  OpenLoopPractice(std::size_t inputs, std::vector<std::size_t> states,
                   AttitudeMotion attitude = {});

  /// Whether a stretch is under way.
  bool running() const { return running_; }

  /// Begins a stretch at the inputs x.
  void begin(std::span<const double> x);

  /// Follows the models to the inputs x, `step_s` > 0 after the ones before. No velocity leaves its
  /// range in `seen` by more than half its width. Requires running().
  void go_on(std::span<const double> x, double step_s, const Accelerations& a,
             const Accelerations& b, std::span<const Extremes> seen);

  /// Ends a stretch without a score, where the samples are interrupted.
  void break_off() { running_ = false; }

  /// After a change of the vehicle: scores so far count as a few.
  void restart();

  /// The share of A, 0 to 1, in the mixture of both models with the least errors over all ages: a
  /// half before anything is known (Bates & Granger 1969).
  double share(std::size_t state) const;

  /// The share of the mixture's change of velocity that has the least error, by age: 1 before
  /// anything is known, 0 where velocity held is best.
  ByAge kept(std::size_t state) const;

  /// Standard deviation of the mixture's errors, so kept, by age, by the bound of nine in ten
  /// errors: conformal_bound(). NaN at ages without a score.
  ByAge off(std::size_t state) const;

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  // Errors of A, of B, and of velocity held, stretch by stretch.
  struct Errors {
    RecentValues a, b, held;
  };
  // Of the velocities, then of the attitude.
  struct Path {
    std::vector<double> value;
    std::vector<double> before;  ///< derivatives one step before
  };

  void advance(Path& path, const Accelerations& accelerations, double step_s,
               std::span<const Extremes> seen);
  void score(std::span<const double> x);
  const Errors& errors(std::size_t state, std::size_t age) const {
    return errors_[state * kPractisedAges.size() + age];
  }

  // Of the mixture with this share of A, the newest stretch first.
  std::vector<double> mixture_errors(std::size_t state, std::size_t age, double share) const;

  std::vector<std::size_t> states_;
  AttitudeMotion attitude_;
  std::vector<std::size_t> integrated_;  ///< the states, then the inputs of the attitude
  Path a_, b_;
  std::vector<double> held_;  ///< velocities at the start
  std::vector<double> from_;  ///< the inputs before
  std::vector<double> at_;    ///< scratch: inputs of one evaluation
  std::vector<double> now_;   ///< scratch: derivatives
  bool running_ = false;
  double age_s_ = 0.0;
  double last_step_s_ = 0.0;    ///< 0: none yet
  std::size_t next_ = 0;        ///< the next age to score
  std::vector<Errors> errors_;  ///< of every state and age
};

}  // namespace kelpie
