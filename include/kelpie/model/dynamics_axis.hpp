// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "kelpie/model/scaled.hpp"
#include "kelpie/model/steady_part.hpp"
#include "kelpie/online/adaptive_svr.hpp"
#include "kelpie/online/conformal.hpp"

namespace kelpie {

/// One axis of a DynamicsModel: the learner, the interval around its predictions, and, where it is
/// known which velocity the target accelerates, the steady part that rollouts need. Neither of the
/// two has a say in predictions.
class DynamicsAxis final : public OnlineRegressor {
 public:
  /// `coverage`: the share of truths that the intervals are to hold, as ConformalInterval has it.
  DynamicsAxis(Scaled<AdaptiveSvr> learner, std::optional<SteadyPart> steady, double coverage)
      : learner_(std::move(learner)), steady_(std::move(steady)), interval_(coverage) {}

  Decision update(std::span<const double> x, double y, double t) override {
    Decision decision = learner_.update(x, y, t);
    if (decision.had_model) {
      decision.lower = decision.predicted - interval_.half_width();
      decision.upper = decision.predicted + interval_.half_width();
      interval_.observe(std::abs(y - decision.predicted));
    }
    if (steady_ && decision.changed) {
      steady_->restart();
    }
    if (steady_ && decision.verdict != Verdict::invalid) {
      steady_->observe(x, y, t);
      if (decision.had_model) {
        steady_->observe_learned(y - decision.predicted);
      }
    }
    return decision;
  }

  void alert(double since_s, bool another) override { learner_.alert(since_s, another); }

  double predict(std::span<const double> x) const override { return learner_.predict(x); }

  Prediction assess(std::span<const double> x) const override {
    Prediction prediction = learner_.assess(x);
    if (learner_.status().ready) {
      prediction.lower = prediction.value - interval_.half_width();
      prediction.upper = prediction.value + interval_.half_width();
    }
    return prediction;
  }

  Status status() const override { return learner_.status(); }
  std::vector<Coefficient> coefficients() const override { return learner_.coefficients(); }

  void visit(Archive& archive) {  ///< core/archive.hpp
    archive.part("learner", learner_);
    if (steady_) {
      archive.part("steady", *steady_);
    }
    archive.part("interval", interval_);
  }

  /// As Scaled::remember().
  void remember(std::vector<RememberedModel> models) { learner_.remember(std::move(models)); }

  const Scaled<AdaptiveSvr>& learner() const { return learner_; }
  SteadyModel steady() const { return steady_ ? steady_->model() : SteadyModel{}; }

 private:
  Scaled<AdaptiveSvr> learner_;
  std::optional<SteadyPart> steady_;
  ConformalInterval interval_;  ///< in the target's own unit
};

}  // namespace kelpie
