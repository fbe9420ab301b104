// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/dynamics_axis.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kelpie {

Committee::Plan DynamicsAxis::committee_plan(const SharedSettings& shared, const TermSet& terms) {
  return {.alone = shared.learner == LearnerKind::svr, .line = terms.without_products()};
}

DynamicsAxis::DynamicsAxis(std::size_t inputs, const SharedSettings& shared,
                           const OnlineSvrSettings& settings, const TermSet& terms,
                           std::optional<AxisScaling> scaling, std::optional<SteadyPart> steady)
    : Scaled(inputs, shared, terms, std::move(scaling)),
      learner_(inputs, terms.size(), settings, committee_plan(shared, terms)),
      steady_(std::move(steady)),
      interval_(shared.coverage),
      corrected_interval_(shared.coverage) {}

Decision DynamicsAxis::update(std::span<const double> x, double y, double t) {
  Decision decision = Scaled::update(x, y, t);
  if (decision.had_model) {
    Prediction& said = decision.prediction;
    said.lower = said.value - interval_.half_width();
    said.upper = said.value + interval_.half_width();
    interval_.observe(std::abs(y - said.value));
    said.disturbance = disturbance_.at(said.value, t);
    const double corrected = said.value + said.disturbance;
    said.corrected_lower = corrected - corrected_interval_.half_width();
    said.corrected_upper = corrected + corrected_interval_.half_width();
    corrected_interval_.observe(std::abs(y - corrected));
    disturbance_.observe(said.value, y, t);
  }
  if (steady_ && decision.changed) {
    steady_->restart();
  }
  const bool learned =
      decision.verdict != Verdict::invalid && decision.verdict != Verdict::implausible;
  if (steady_ && learned) {
    steady_->observe(x, y, t);
    if (decision.had_model) {
      steady_->observe_learned(y - decision.prediction.value);
    }
  }
  return decision;
}

Prediction DynamicsAxis::assess(std::span<const double> x, double ahead_s) const {
  const double novelty =
      scaling() != nullptr ? svr().novelty(as_span(scale_sample(*scaling(), terms(), x))) : 1.0;
  return interval_state().prediction(predict(x), novelty, ahead_s);
}

IntervalState DynamicsAxis::interval_state() const {
  return {.ready = learner_.status().ready,
          .half_width = interval_.half_width(),
          .corrected_half_width = corrected_interval_.half_width(),
          .disturbance = disturbance_};
}

Prediction IntervalState::prediction(double value, double novelty, double ahead_s) const {
  Prediction prediction{.value = value, .novelty = novelty};
  if (ready) {
    prediction.lower = value - half_width;
    prediction.upper = value + half_width;
    prediction.disturbance = disturbance.ahead(value, ahead_s);
    if (disturbance.is_next(ahead_s)) {
      const double corrected = value + prediction.disturbance;
      prediction.corrected_lower = corrected - corrected_half_width;
      prediction.corrected_upper = corrected + corrected_half_width;
    }
  }
  return prediction;
}

std::vector<Coefficient> DynamicsAxis::coefficients() const {
  std::vector<Coefficient> list;
  for (std::size_t k = 0; scaling() != nullptr && k < terms().size(); ++k) {
    const double scale = scaling()->target.scale;
    const double term_scale = scaling()->term_scale[k];
    list.push_back({.term = terms().text(k),
                    .value = scale * learner_.term_weight(k) / term_scale,
                    .error = scale * learner_.term_error(k) / term_scale});
  }
  return list;
}

std::vector<StoredPastModel> DynamicsAxis::past_models() const {
  std::vector<StoredPastModel> list = awaited_;
  if (scaling() != nullptr) {
    const std::span<const PastModel> models = svr().memory().models();
    for (std::size_t k = 0; k < models.size(); ++k) {
      const bool follows = before_scaling() != nullptr && k >= svr().rescaled();
      list.push_back(in_log_units(models[k], follows ? *before_scaling() : *scaling()));
    }
  }
  return list;
}

void DynamicsAxis::set_past_models(std::vector<StoredPastModel> models) {
  awaited_ = std::move(models);
  if (scaling() != nullptr) {
    scale_found();
  }
}

void DynamicsAxis::scale_found() {
  for (const StoredPastModel& model : awaited_) {
    // NOLINTNEXTLINE(bugprone-unchecked-optional-access): it has been found
    learner_.learner().add_past(in_learner_units(model, *scaling(), terms(), svr().champion()));
  }
  awaited_.clear();
}

void DynamicsAxis::resume_from(const AxisScaling& scaling, const FunctionMix& said, double t) {
  Scaled::resume_from(scaling);
  const std::size_t inputs = scaling.input.dimension();
  const auto complete = [&](std::span<double> sample) {
    const ScaledInput x = scaling.input.invert(sample.first(inputs));
    const ScaledSample whole = scale_sample(scaling, terms(), as_span(x));
    std::ranges::copy(as_span(whole).subspan(inputs), sample.subspan(inputs).begin());
  };
  learner_.resume_from(said, complete, t);
}

RescaleStatus DynamicsAxis::rescale(const SampleMap& map) {
  return learner_.rescale(map);
}

void DynamicsAxis::visit(Archive& archive) {
  Scaled::visit(archive);
  archive.part("learner", learner_);
  if (steady_) {
    archive.part("steady", *steady_);
  }
  archive.part("interval", interval_);
  archive.part("disturbance", disturbance_);
  archive.part("interval with disturbance", corrected_interval_);
  if (archive.loading() && scaling() != nullptr) {
    awaited_.clear();  // they are among the learner's
  }
}

}  // namespace kelpie
