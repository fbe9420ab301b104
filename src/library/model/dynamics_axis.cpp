// SPDX-License-Identifier: Apache-2.0
#include "model/dynamics_axis.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kelpie {
namespace {

// The committee in service, as ServedAxis takes a function.
struct Served {
  const Committee& committee;

  double operator()(std::span<const double> z) const { return committee.predict(z); }
  double with_gradient(std::span<const double> z, std::span<double> gradient) const {
    return committee.with_gradient(z, gradient);
  }
};

}  // namespace

Committee::Plan committee_plan(const SharedSettings& shared, const TermSet& terms) {
  return {.alone = shared.learner == LearnerKind::svr, .line = terms.without_products()};
}

DynamicsAxis::DynamicsAxis(std::size_t inputs, const SharedSettings& shared,
                           const OnlineSvrSettings& settings, const TermSet& terms,
                           std::optional<AxisScaling> scaling)
    : Scaled(inputs, shared, terms, std::move(scaling)),
      learner_(inputs, terms.size(), settings, committee_plan(shared, terms)),
      uncertainty_(shared.coverage) {}

// The way of a sample through one axis (docs/reference/architecture.md).
Decision DynamicsAxis::update(std::span<const double> x, double y, double t) {
  Decision decision = Scaled::update(x, y, t);  // check, scale, predict, learn
  uncertainty_.score(decision, y, t);
  return decision;
}

Prediction DynamicsAxis::assess(std::span<const double> x, double ahead_s) const {
  IntervalState intervals;
  if (learner_.status().ready) {
    intervals = uncertainty_.intervals();
  }
  if (scaling() == nullptr) {
    return intervals.prediction(predict(x), 1.0, ahead_s);
  }
  const auto novelty = [&](std::span<const double> z) { return svr().novelty(z); };
  const Served served{learner_};
  return ServedAxis<Served>{*scaling(), terms(), served}.assess(x, intervals, novelty, ahead_s);
}

double DynamicsAxis::predict_with_gradient(std::span<const double> x,
                                           std::span<double> gradient) const {
  if (scaling() != nullptr && learner_.status().ready) {
    const Served served{learner_};
    return ServedAxis<Served>{*scaling(), terms(), served}.predict_with_gradient(x, gradient);
  }
  std::ranges::fill(gradient, 0.0);
  return predict(x);
}

Snapshot DynamicsAxis::snapshot() const {
  const std::size_t inputs = this->inputs();
  Snapshot copy{.name = {},
                .scaling = {.input = {std::vector<double>(inputs), Matrix(inputs, inputs)},
                            .target = {},
                            .term_scale = std::vector<double>(terms().size())},
                .function = learner_.function_mix(),
                .known = known_places(svr().champion().buffer())};
  if (scaling() != nullptr) {
    refresh(copy);
  }
  return copy;
}

void DynamicsAxis::refresh(Snapshot& copy) const {
  copy.scaling = *scaling();
  learner_.refresh(copy.function);
  kelpie::refresh(*copy.known, svr().champion().buffer());
  uncertainty_.refresh(copy);
}

Snapshot DynamicsAxis::trained(std::string name) const {
  return {.name = std::move(name),
          .scaling = *scaling(),
          .function = learner_.function_mix(),
          .kkt_gap = learner_.status().kkt_gap,
          .half_width = uncertainty_.half_width(),
          .known = known_places(svr().champion().buffer())};
}

void DynamicsAxis::apply_change(std::span<const CommandGain> gains, std::span<const double> step,
                                const Decision& news) {
  if (scaling() == nullptr) {
    return;
  }
  if (!gains.empty()) {
    for (const CommandGain& gain : gains) {
      amplify(gain);
    }
    learner_.shift({}, news);
    return;
  }
  learner_.shift(as_span(scaled_weights(step)), news);
}

// The last coefficient is of the term 1; terms that are not named have 0.
ShortVector<kMostTerms + 1> DynamicsAxis::scaled_weights(
    std::span<const double> coefficients) const {
  ShortVector<kMostTerms + 1> scaled(terms().size() + 1);
  const double scale = scaling()->target.scale;
  std::ranges::fill(scaled, 0.0);
  for (std::size_t k = 0; k + 1 < coefficients.size(); ++k) {
    scaled[k] = coefficients[k] * scaling()->term_scale[k] / scale;
  }
  scaled[terms().size()] = coefficients.back() / scale;
  return scaled;
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
    const std::span<const PastModel> models = svr().past_models().models();
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

void DynamicsAxis::expect_vehicle(std::span<const double> coefficients) {
  expected_.assign(coefficients.begin(), coefficients.end());
  if (scaling() != nullptr) {
    scale_found();
  }
}

void DynamicsAxis::scale_found() {
  if (!expected_.empty()) {
    const TargetScaling& target = scaling()->target;
    expected_.back() -= target.mean;
    learner_.expect(as_span(scaled_weights(expected_)));
    expected_.clear();
  }
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
  archive.list(expected_, terms().size() + 1, [&](double& one) { archive.number(one); });
  archive.part("learner", learner_);
  uncertainty_.visit(archive);
  if (archive.loading() && scaling() != nullptr) {
    awaited_.clear();  // they are among the learner's
  }
}

}  // namespace kelpie
