// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/scale_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kelpie {
namespace {

constexpr std::size_t kLookEvery = 64;  // samples between two checks of the drift

}  // namespace

ScaleTracker::ScaleTracker(std::size_t inputs, const SharedSettings& settings, TermSet terms,
                           std::optional<AxisScaling> given)
    : inputs_(inputs),
      kind_(settings.scaling),
      track_(given ? 0.0 : settings.track),
      given_(given.has_value()),
      terms_(std::move(terms)),
      input_moments_(given_ ? 0 : inputs),
      target_moments_(given_ ? 0 : 1),
      term_moments_(given_ ? 0 : terms_.size()),
      term_values_(terms_.size()),
      scaling_(std::move(given)) {}

void ScaleTracker::observe(std::span<const double> x, double y) {
  if (scaling_ && track_ == 0.0) {
    return;
  }
  input_moments_.add(x);
  target_moments_.add({&y, 1});
  terms_.evaluate(x, term_values_);
  term_moments_.add(term_values_);
}

double ScaleTracker::mean_target() const {
  return target_moments_.count() > 0 ? target_moments_.mean()[0] : 0.0;
}

std::optional<AxisScaling> ScaleTracker::next() const {
  return !scaling_ || outgrown(*scaling_) ? measured() : std::nullopt;
}

void ScaleTracker::adopt(AxisScaling next) {
  scaling_ = std::move(next);
}

std::optional<AxisScaling> ScaleTracker::measured() const {
  const double variance = target_moments_.covariance()(0, 0);
  auto input = InputScaling::from(input_moments_, kind_);
  if (!input || !(variance > 0.0)) {
    return std::nullopt;
  }
  return AxisScaling{*std::move(input),
                     {mean_target(), std::sqrt(variance)},
                     terms_.scales(input_moments_, term_moments_)};
}

bool ScaleTracker::outgrown(const AxisScaling& scaling) const {
  if (track_ == 0.0 || input_moments_.count() % kLookEvery != 0) {
    return false;
  }
  const double ratio = std::sqrt(target_moments_.covariance()(0, 0)) / scaling.target.scale;
  return std::max({scaling.input.drift(input_moments_), ratio, 1.0 / ratio}) > track_;
}

SampleMap ScaleTracker::map_to(const AxisScaling& next) const {
  return [this, &next](std::span<double> x, double& y) {
    const AxisScaling& now = *scaling_;  // NOLINT(bugprone-unchecked-optional-access): required
    const ScaledInput raw = now.input.invert(x.first(inputs_));
    std::ranges::copy(as_span(next.input.apply(as_span(raw))), x.begin());
    for (std::size_t k = 0; k < terms_.size(); ++k) {
      x[inputs_ + k] *= now.term_scale[k] / next.term_scale[k];
    }
    y = next.target.apply(now.target.invert(y));
  };
}

void ScaleTracker::visit(Archive& archive) {
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
}

}  // namespace kelpie
