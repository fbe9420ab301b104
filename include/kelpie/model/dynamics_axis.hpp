// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "kelpie/model/scaled.hpp"
#include "kelpie/model/steady_part.hpp"
#include "kelpie/online/adaptive_svr.hpp"

namespace kelpie {

/// One axis of a DynamicsModel: the learner, and beside it, where it is known which velocity the
/// target accelerates, the steady part that rollouts need. That has no say in predictions.
class DynamicsAxis final : public OnlineRegressor {
 public:
  DynamicsAxis(Scaled<AdaptiveSvr> learner, std::optional<SteadyPart> steady)
      : learner_(std::move(learner)), steady_(std::move(steady)) {}

  Decision update(std::span<const double> x, double y, double t) override {
    const Decision decision = learner_.update(x, y, t);
    if (steady_ && decision.changed) {
      steady_->restart();
    }
    if (steady_ && decision.verdict != Verdict::invalid) {
      steady_->observe(x, y, t);
    }
    return decision;
  }

  double predict(std::span<const double> x) const override { return learner_.predict(x); }
  Status status() const override { return learner_.status(); }
  std::vector<Coefficient> coefficients() const override { return learner_.coefficients(); }

  void visit(Archive& archive) {  ///< core/archive.hpp
    archive.part("learner", learner_);
    if (steady_) {
      archive.part("steady", *steady_);
    }
  }

  const Scaled<AdaptiveSvr>& learner() const { return learner_; }
  SteadyModel steady() const { return steady_ ? steady_->model() : SteadyModel{}; }

 private:
  Scaled<AdaptiveSvr> learner_;
  std::optional<SteadyPart> steady_;
};

}  // namespace kelpie
