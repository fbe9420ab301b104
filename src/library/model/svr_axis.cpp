// SPDX-License-Identifier: Apache-2.0
#include "model/svr_axis.hpp"

#include <algorithm>
#include <utility>

#include "kelpie/core/error.hpp"
#include "svr/past_model.hpp"
#include "svr/sample_collector.hpp"
#include "svr/svr_function.hpp"

namespace kelpie {
namespace {

// The learner, as ServedAxis takes a function: with a mean before the first model.
struct Served {
  const OnlineSvr& learner;

  double operator()(std::span<const double> z) const { return learner.predict(z); }
  double with_gradient(std::span<const double> z, std::span<double> gradient) const {
    return learner.model().with_gradient(z, gradient);
  }
};

}  // namespace

SvrAxis::SvrAxis(std::size_t inputs, const SharedSettings& shared,
                 const OnlineSvrSettings& settings, const TermSet& terms,
                 std::optional<AxisScaling> scaling)
    : scale_(inputs, shared, terms, std::move(scaling)),
      learner_(inputs, settings, terms.size()),
      uncertainty_(shared.coverage) {}

std::size_t SvrAxis::bytes(std::size_t inputs, std::size_t terms,
                           const OnlineSvrSettings& settings) {
  return sizeof(SvrAxis) + OnlineSvr::bytes(inputs, settings, terms);
}

// The way of a sample.
Decision SvrAxis::update(std::span<const double> x, double y, double t) {
  Decision decision = scale_.update(learner_, x, y, t);
  uncertainty_.score(decision, y, t);
  return decision;
}

Prediction SvrAxis::assess(std::span<const double> x, double ahead_s) const {
  const IntervalState intervals = learner_.ready() ? uncertainty_.intervals() : IntervalState{};
  if (scaling() == nullptr) {
    return intervals.prediction(predict(x), 1.0, ahead_s);
  }
  const auto novelty = [&](std::span<const double> z) {
    return kelpie::novelty(learner_.buffer(), z);
  };
  const Served served{learner_};
  return ServedAxis<Served>{*scaling(), terms(), served}.assess(x, intervals, novelty, ahead_s);
}

double SvrAxis::predict_with_gradient(std::span<const double> x, std::span<double> gradient) const {
  if (learner_.ready()) {
    const Served served{learner_};
    return ServedAxis<Served>{*scaling(), terms(), served}.predict_with_gradient(x, gradient);
  }
  std::ranges::fill(gradient, 0.0);
  return predict(x);
}

std::vector<Coefficient> SvrAxis::coefficients() const {
  std::vector<Coefficient> list;
  for (std::size_t k = 0; scaling() != nullptr && k < terms().size(); ++k) {
    const double weight = learner_.model().term_weights()[k];
    list.push_back({.term = terms().text(k),
                    .value = scaling()->target.scale * weight / scaling()->term_scale[k]});
  }
  return list;
}

FunctionMix SvrAxis::function() const {
  return {.members = {{.name = "learner", .share = 1.0, .function = learner_.model()}}};
}

Snapshot SvrAxis::snapshot() const {
  const std::size_t inputs = learner_.buffer().kernel().inputs();
  Snapshot copy{.name = {},
                .scaling = {.input = {std::vector<double>(inputs), Matrix(inputs, inputs)},
                            .target = {},
                            .term_scale = std::vector<double>(terms().size())},
                .function = function(),
                .known = known_places(learner_.buffer())};
  if (scaling() != nullptr) {
    refresh(copy);
  }
  return copy;
}

void SvrAxis::refresh(Snapshot& copy) const {
  copy.scaling = *scaling();
  copy.function.members.front().function.assign(learner_.model());
  kelpie::refresh(*copy.known, learner_.buffer());
  uncertainty_.refresh(copy);
}

Snapshot SvrAxis::trained(std::string name) const {
  return {.name = std::move(name),
          .scaling = *scaling(),
          .function = function(),
          .kkt_gap = learner_.status().kkt_gap,
          .half_width = uncertainty_.half_width(),
          .known = known_places(learner_.buffer())};
}

void SvrAxis::set_past_models(std::vector<StoredPastModel> models) {
  require(models.empty(), "past models", "are of no use to 'learner = svr', which keeps none");
}

void SvrAxis::resume_from(const Snapshot& trained, double t) {
  scale_.resume_from(trained.scaling);
  const std::size_t inputs = trained.scaling.input.dimension();
  const auto complete = [&](std::span<double> sample) {
    const ScaledInput x = trained.scaling.input.invert(sample.first(inputs));
    const ScaledSample whole = scale_sample(trained.scaling, terms(), as_span(x));
    std::ranges::copy(as_span(whole).subspan(inputs), sample.subspan(inputs).begin());
  };
  PastModel samples(learner_.buffer().kernel(), learner_.settings().places());
  samples.keep(trained.function.members.front().function, learner_.settings(), complete);
  learner_.relearn(samples, t);
}

void SvrAxis::visit(Archive& archive) {
  archive.part("scale", scale_);
  archive.part("learner", learner_);
  uncertainty_.visit(archive);
}

}  // namespace kelpie
