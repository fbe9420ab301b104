// SPDX-License-Identifier: Apache-2.0
#include "model/scaled.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "model/tuning.hpp"
#include "svr/valid_sample.hpp"

namespace kelpie {
namespace {

constexpr const auto& kHeldTuning = kModelTuning.scale;

// What another sample brought about at the same step.
void join(Decision& decision, const Decision& other) {
  decision.iterations += other.iterations;
  if (other.changed || other.returning) {
    decision.changed = decision.changed || other.changed;
    decision.returning = decision.returning || other.returning;
    decision.changed_since = other.changed_since;
    decision.recalled = other.recalled;
  }
}

}  // namespace

Scaled::Scaled(std::size_t inputs, const SharedSettings& settings, TermSet terms,
               std::optional<AxisScaling> scaling)
    : scale_(inputs, settings, std::move(terms), std::move(scaling)),
      warm_up_(inputs,
               scale_.scaling() != nullptr ? 0 : static_cast<std::size_t>(settings.warmup)) {}

Decision Scaled::update(std::span<const double> x, double y, double t) {
  if (!valid_sample(x, scale_.inputs(), y, t)) {
    ++invalid_;
    return {.verdict = Verdict::invalid,
            .prediction = {.value = std::numeric_limits<double>::quiet_NaN()},
            .kkt_gap = learner().status().kkt_gap};
  }
  if (scaling() == nullptr) {
    return hold_back(x, y, t);
  }
  scale_.observe(x, y);
  change_scale();
  return warm_up_.size() > 0 ? stand_in_line(x, y, t) : learn(*scaling(), x, y, t);
}

Decision Scaled::hold_back(std::span<const double> x, double y, double t) {
  Decision decision{.verdict = Verdict::held_back, .prediction = {.value = scale_.mean_target()}};
  scale_.observe(x, y);
  warm_up_.hold(x, y, t);
  if (warm_up_.full() && held_++ % kHeldTuning.held_look == 0 && find_scale()) {
    learn_held(decision);
  }
  return decision;
}

// Behind the samples that are still held back.
Decision Scaled::stand_in_line(std::span<const double> x, double y, double t) {
  Decision held{.verdict = Verdict::held_back,
                .prediction = {.value = predict(x)},
                .had_model = learner().status().ready};
  learn_held(held);
  if (warm_up_.size() > 0) {
    warm_up_.hold(x, y, t);
    return held;
  }
  warm_up_.clear();
  Decision decision = learn(*scaling(), x, y, t);
  join(decision, held);
  return decision;
}

// Whether the samples held back determine one; if so, those that are plausible are left.
bool Scaled::find_scale() {
  const std::vector<bool> plausible = plausible_samples(warm_up_, scale_.inputs());
  scale_.restart();
  for (std::size_t i = 0; i < warm_up_.size(); ++i) {
    if (plausible[i]) {
      scale_.observe(warm_up_[i].x, warm_up_[i].y);
    }
  }
  if (scale_.next() == nullptr) {
    return false;
  }
  scale_.adopt();
  scale_found();
  implausible_ += std::ranges::count(plausible, false);
  warm_up_.keep(plausible);
  return true;
}

// The oldest of the samples held back.
void Scaled::learn_held(Decision& decision) {
  const std::size_t count = std::min(kHeldTuning.held_slice, warm_up_.size());
  for (std::size_t i = 0; i < count; ++i) {
    const WarmUp::Sample sample = warm_up_[i];
    const Decision step = learn(*scaling(), sample.x, sample.y, sample.t);
    join(decision, step);
    decision.kkt_gap = step.kkt_gap;
    decision.published = step.published;
  }
  warm_up_.drop_oldest(count);
}

void Scaled::expect(const ThinnedRows& samples, std::size_t first) {
  scale_.lighten(std::max<std::size_t>(2, samples.size() - first));
  for (std::size_t i = first; i < samples.size(); ++i) {
    scale_.observe(samples[i].x, samples[i].y);
  }
}

void Scaled::learn_held_back() {
  Decision decision;
  while (scaling() != nullptr && warm_up_.size() > 0) {
    learn_held(decision);
  }
}

Decision Scaled::learn(const AxisScaling& scaling, std::span<const double> x, double y, double t) {
  Decision decision =
      learner().update(as_span(scale_sample(scaling, terms(), x)), scaling.target.apply(y), t);
  decision.prediction.value = scaling.target.invert(decision.prediction.value);
  return decision;
}

void Scaled::change_scale() {
  if (scale_.next() != nullptr) {
    scale_.set_out();
  }
  if (!scale_.on_the_way()) {
    return;
  }
  const RescaleStatus step = rescale(scale_.map());
  const bool arrived = step == RescaleStatus::switched || step == RescaleStatus::done;
  if (arrived && scale_.before() == nullptr) {
    scale_.adopt();
  }
  if (step == RescaleStatus::refused || step == RescaleStatus::done) {
    scale_.arrive();
  }
}

double Scaled::predict(std::span<const double> x) const {
  if (scaling() == nullptr) {
    return scale_.mean_target();
  }
  return scaling()->target.invert(learner().predict(as_span(scale_sample(*scaling(), terms(), x))));
}

Status Scaled::status() const {
  Status status = learner().status();
  status.tally.invalid += invalid_;
  status.tally.implausible += implausible_;
  return status;
}

void Scaled::visit(Archive& archive) {
  archive.part("scale", scale_);
  archive.part("warm-up", warm_up_);
  archive.whole(invalid_);
  archive.whole(implausible_);
  archive.whole(held_);
}

}  // namespace kelpie
