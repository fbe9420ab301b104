// SPDX-License-Identifier: Apache-2.0
#include "model/first_scale.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/quantile.hpp"
#include "model/tuning.hpp"
#include "svr/valid_sample.hpp"

namespace kelpie {
namespace {

constexpr const auto& kScaleTuning = kModelTuning.scale;

}  // namespace

FirstScale::FirstScale(std::size_t inputs, const SharedSettings& settings, TermSet terms,
                       std::optional<AxisScaling> given)
    : inputs_(inputs),
      kind_(settings.scaling),
      given_(given.has_value()),
      terms_(std::move(terms)),
      input_moments_(inputs, kScaleTuning.remembered),
      target_moments_(1, kScaleTuning.remembered),
      term_moments_(terms_.size(), kScaleTuning.remembered),
      term_values_(terms_.size()),
      scaling_(std::move(given)),
      warm_up_(inputs, given_ ? 0 : static_cast<std::size_t>(settings.warmup)) {}

Decision FirstScale::update(OnlineRegressor& learner, std::span<const double> x, double y,
                            double t) {
  if (!valid_sample(x, inputs_, y, t)) {
    ++invalid_;
    return {.verdict = Verdict::invalid,
            .prediction = {.value = std::numeric_limits<double>::quiet_NaN()},
            .kkt_gap = learner.status().kkt_gap};
  }
  if (!scaling_) {
    return hold_back(learner, x, y, t);
  }
  return warm_up_.size() > 0 ? stand_in_line(learner, x, y, t) : learn(learner, x, y, t);
}

Decision FirstScale::hold_back(OnlineRegressor& learner, std::span<const double> x, double y,
                               double t) {
  Decision decision{.verdict = Verdict::held_back, .prediction = {.value = mean_target()}};
  observe(x, y);
  warm_up_.hold(x, y, t);
  if (warm_up_.full() && held_++ % kScaleTuning.held_look == 0 && find()) {
    learn_held(learner, decision);
  }
  return decision;
}

// Behind the samples that are still held back.
Decision FirstScale::stand_in_line(OnlineRegressor& learner, std::span<const double> x, double y,
                                   double t) {
  Decision held{.verdict = Verdict::held_back,
                .prediction = {.value = predict(learner, x)},
                .had_model = learner.status().ready};
  learn_held(learner, held);
  if (warm_up_.size() > 0) {
    warm_up_.hold(x, y, t);
    return held;
  }
  warm_up_.clear();
  Decision decision = learn(learner, x, y, t);
  decision.iterations += held.iterations;
  return decision;
}

void FirstScale::observe(std::span<const double> x, double y) {
  input_moments_.add(x);
  target_moments_.add({&y, 1});
  terms_.evaluate(x, term_values_);
  term_moments_.add(term_values_);
}

double FirstScale::mean_target() const {
  return target_moments_.count() > 0 ? target_moments_.mean()[0] : 0.0;
}

// Whether the samples held back determine a scale; if so, those that are plausible are left.
bool FirstScale::find() {
  const std::vector<bool> plausible = plausible_samples(warm_up_, inputs_);
  input_moments_ = Moments(inputs_, kScaleTuning.remembered);
  target_moments_ = Moments(1, kScaleTuning.remembered);
  term_moments_ = Moments(terms_.size(), kScaleTuning.remembered);
  for (std::size_t i = 0; i < warm_up_.size(); ++i) {
    if (plausible[i]) {
      observe(warm_up_[i].x, warm_up_[i].y);
    }
  }
  std::optional<InputScaling> input = InputScaling::from(input_moments_, kind_);
  const double variance = target_moments_.covariance(0, 0);
  if (!input || !(variance > 0.0)) {
    return false;
  }
  scaling_ = {
      std::move(*input), {mean_target(), std::sqrt(variance)}, std::vector<double>(terms_.size())};
  terms_.scales(input_moments_, term_moments_, scaling_->term_scale);
  implausible_ += std::ranges::count(plausible, false);
  warm_up_.keep(plausible);
  return true;
}

// The oldest of the samples held back.
void FirstScale::learn_held(OnlineRegressor& learner, Decision& decision) {
  const std::size_t count = std::min(kScaleTuning.held_slice, warm_up_.size());
  for (std::size_t i = 0; i < count; ++i) {
    const WarmUp::Sample sample = warm_up_[i];
    const Decision step = learn(learner, sample.x, sample.y, sample.t);
    decision.iterations += step.iterations;
    decision.kkt_gap = step.kkt_gap;
    decision.published = step.published;
  }
  warm_up_.drop_oldest(count);
}

void FirstScale::learn_held_back(OnlineRegressor& learner) {
  Decision decision;
  while (scaling_ && warm_up_.size() > 0) {
    learn_held(learner, decision);
  }
}

// NOLINTBEGIN(bugprone-unchecked-optional-access): the scale is known
Decision FirstScale::learn(OnlineRegressor& learner, std::span<const double> x, double y,
                           double t) {
  Decision decision =
      learner.update(as_span(scale_sample(*scaling_, terms_, x)), scaling_->target.apply(y), t);
  decision.prediction.value = scaling_->target.invert(decision.prediction.value);
  return decision;
}
// NOLINTEND(bugprone-unchecked-optional-access)

double FirstScale::predict(const OnlineRegressor& learner, std::span<const double> x) const {
  return scaling_
             ? scaling_->target.invert(learner.predict(as_span(scale_sample(*scaling_, terms_, x))))
             : mean_target();
}

Status FirstScale::status(const OnlineRegressor& learner) const {
  Status status = learner.status();
  status.tally.invalid += invalid_;
  status.tally.implausible += implausible_;
  return status;
}

void FirstScale::visit(Archive& archive) {
  archive.same("scales", given_ ? "given" : "from the first samples");
  archive.part("moments", input_moments_);
  archive.part("target_moments", target_moments_);
  archive.part("term_moments", term_moments_);
  bool known = scaling_.has_value();
  archive.flag(known);
  archive.require(known || !given_, "lacks the scaling it was given");
  if (archive.loading() && known) {
    scaling_.emplace();
  }
  if (scaling_) {
    archive.part("scaling", *scaling_, inputs_, terms_.size());
  }
  archive.part("warm-up", warm_up_);
  archive.whole(invalid_);
  archive.whole(implausible_);
  archive.whole(held_);
}

std::vector<bool> plausible_samples(const WarmUp& samples, std::size_t inputs) {
  std::vector<bool> plausible(samples.size(), true);
  const auto value = [&](std::size_t i, std::size_t column) {
    return column < inputs ? samples[i].x[column] : samples[i].y;
  };
  std::vector<double> column(samples.size());
  for (std::size_t k = 0; k <= inputs; ++k) {
    for (std::size_t i = 0; i < column.size(); ++i) {
      column[i] = value(i, k);
    }
    const double median = quantile(column, 0.5);
    const double below = kScaleTuning.far * (median - quantile(column, 0.05));
    const double above = kScaleTuning.far * (quantile(column, 0.95) - median);
    const double most = std::max(below, above);
    std::ranges::transform(column, column.begin(), [](double one) { return std::abs(one); });
    const double beyond = kScaleTuning.beyond * quantile(column, 0.95);
    for (std::size_t i = 0; i < plausible.size(); ++i) {
      const bool far = std::abs(value(i, k) - median) > most;
      const bool is_usual = k < inputs && std::abs(value(i, k)) <= beyond;
      plausible[i] = plausible[i] && (!far || is_usual);
    }
  }
  return plausible;
}

}  // namespace kelpie
