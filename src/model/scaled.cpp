// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/scaled.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "kelpie/online/valid_sample.hpp"

namespace kelpie {
namespace {

constexpr std::int64_t kHeldLook = 16;  // samples held back between two looks for a scale

}  // namespace

Scaled::Scaled(std::size_t inputs, const SharedSettings& settings, TermSet terms,
               std::optional<AxisScaling> scaling)
    : scale_(inputs, settings, std::move(terms), std::move(scaling)),
      warm_up_(inputs,
               scale_.scaling() != nullptr ? 0 : static_cast<std::size_t>(settings.warmup)) {}

Decision Scaled::update(std::span<const double> x, double y, double t) {
  if (!valid_sample(x, scale_.inputs(), y, t)) {
    ++invalid_;
    return {.verdict = Verdict::invalid, .kkt_gap = learner().status().kkt_gap};
  }
  if (scaling() == nullptr) {
    return hold_back(x, y, t);
  }
  if (!scale_.plausible(x, y)) {
    ++implausible_;
    return {.verdict = Verdict::implausible, .kkt_gap = learner().status().kkt_gap};
  }
  follow(x, y);
  return learn(*scaling(), x, y, t);
}

Decision Scaled::hold_back(std::span<const double> x, double y, double t) {
  Decision decision{.verdict = Verdict::held_back, .predicted = scale_.mean_target()};
  scale_.observe(x, y);
  warm_up_.hold(x, y, t);
  if (warm_up_.full() && held_++ % kHeldLook == 0) {
    learn_held(decision);
  }
  return decision;
}

// The samples held back, if they determine a scale.
void Scaled::learn_held(Decision& decision) {
  const std::vector<bool> plausible = plausible_samples(warm_up_, scale_.inputs());
  const auto for_each_sample = [&](auto use) {
    for (std::size_t i = 0; i < warm_up_.size(); ++i) {
      if (plausible[i]) {
        use(warm_up_[i]);
      }
    }
  };
  scale_.restart();
  for_each_sample([&](const WarmUp::Sample& sample) { scale_.observe(sample.x, sample.y); });
  if (scale_.next() == nullptr) {
    return;
  }
  scale_.adopt();
  scale_found();
  for_each_sample([&](const WarmUp::Sample& sample) {
    const Decision step = learn(*scaling(), sample.x, sample.y, sample.t);
    decision.iterations += step.iterations;
    if (step.changed) {
      decision.changed = true;
      decision.changed_since = step.changed_since;
      decision.recalled = step.recalled;
    }
    decision.kkt_gap = step.kkt_gap;
    decision.served = step.served;
  });
  implausible_ += std::ranges::count(plausible, false);
  warm_up_.clear();
}

Decision Scaled::learn(const AxisScaling& scaling, std::span<const double> x, double y, double t) {
  Decision decision =
      learner().update(as_span(scale_sample(scaling, terms(), x)), scaling.target.apply(y), t);
  decision.predicted = scaling.target.invert(decision.predicted);
  return decision;
}

void Scaled::follow(std::span<const double> x, double y) {
  scale_.observe(x, y);
  const AxisScaling* const next = scale_.next();
  if (next != nullptr && restate(scale_.map_to(*next))) {
    scale_.adopt();
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
