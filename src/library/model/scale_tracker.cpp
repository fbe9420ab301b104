// SPDX-License-Identifier: Apache-2.0
#include "model/scale_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/eigen.hpp"
#include "core/quantile.hpp"
#include "model/tuning.hpp"

namespace kelpie {
namespace {

constexpr const auto& kScaleTuning = kModelTuning.scale;

}  // namespace

ScaleTracker::ScaleTracker(std::size_t inputs, const SharedSettings& settings, TermSet terms,
                           std::optional<AxisScaling> given)
    : inputs_(inputs),
      kind_(settings.scaling),
      track_(settings.track),
      given_(given.has_value()),
      terms_(std::move(terms)),
      input_moments_(given_ ? 0 : inputs, kScaleTuning.remembered),
      target_moments_(given_ ? 0 : 1, kScaleTuning.remembered),
      term_moments_(given_ ? 0 : terms_.size(), kScaleTuning.remembered),
      term_values_(terms_.size()),
      largest_(inputs),
      scaling_(std::move(given)) {
  next_.input.mean.reserve(inputs);
  next_.input.whitening = Matrix(inputs, inputs);
  next_.term_scale.resize(terms_.size());
  if (scaling_) {
    see(scaling_->input);
  }
}

bool ScaleTracker::plausible(std::span<const double> x, double y) const {
  return !far(y) && !any_far(x, true);
}

bool ScaleTracker::any_far(std::span<const double> x, bool but_held) const {
  // NOLINTNEXTLINE(bugprone-unchecked-optional-access): required
  const InputScaling& input = scaling_->input;
  const ScaledInput z = input.apply(x);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double whitening = input.whitening(i, i);  // 0: the input has never moved
    const bool is_far =
        whitening == 0.0 ? x[i] != input.mean[i] : std::abs(as_span(z)[i]) > kScaleTuning.far;
    const bool held = whitening == 0.0 || 1.0 < kScaleTuning.held * largest_[i] * whitening;
    if (is_far && (!but_held || !held || std::abs(x[i]) > kScaleTuning.beyond * largest_[i])) {
      return true;
    }
  }
  return false;
}

bool ScaleTracker::far(double y) const {
  // NOLINTNEXTLINE(bugprone-unchecked-optional-access): required
  return std::abs(scaling_->target.apply(y)) > kScaleTuning.far;
}

void ScaleTracker::restart() {
  input_moments_ = Moments(inputs_, kScaleTuning.remembered);
  target_moments_ = Moments(1, kScaleTuning.remembered);
  term_moments_ = Moments(terms_.size(), kScaleTuning.remembered);
  std::ranges::fill(largest_, 0.0);
  observed_ = 0;
}

void ScaleTracker::see(std::span<const double> x) {
  for (std::size_t i = 0; i < x.size(); ++i) {
    largest_[i] = std::max(largest_[i], std::abs(x[i]));
  }
}

// As after many samples of this scale.
void ScaleTracker::see(const InputScaling& scaling) {
  const Matrix covariance = scaling.covariance();
  for (std::size_t i = 0; i < inputs_; ++i) {
    largest_[i] = std::abs(scaling.mean[i]) + kScaleTuning.extreme * std::sqrt(covariance(i, i));
  }
}

void ScaleTracker::lighten(std::size_t count) {
  for (Moments* const moments : {&input_moments_, &target_moments_, &term_moments_}) {
    moments->lighten(count);
  }
}

void ScaleTracker::resume_from(AxisScaling scaling) {
  const auto variances = [](std::span<const double> deviations) {
    Matrix diagonal(deviations.size(), deviations.size());
    for (std::size_t i = 0; i < deviations.size(); ++i) {
      diagonal(i, i) = deviations[i] * deviations[i];
    }
    return diagonal;
  };
  const TargetScaling& target = scaling.target;
  input_moments_.assume(scaling.input.mean, scaling.input.covariance(), kScaleTuning.assumed);
  target_moments_.assume({&target.mean, 1}, variances({&target.scale, 1}), kScaleTuning.assumed);
  term_moments_.assume(std::vector<double>(terms_.size()), variances(scaling.term_scale),
                       kScaleTuning.assumed);
  scaling_ = std::move(scaling);
  see(scaling_->input);
}

void ScaleTracker::observe(std::span<const double> x, double y) {
  if (!counts()) {
    return;
  }
  ++observed_;
  const bool far_inputs = scaling_ && far(x);
  far_ = far_inputs || (scaling_ && far(y));
  if (!far_inputs) {
    see(x);
  }
  input_moments_.add(x);
  target_moments_.add({&y, 1});
  terms_.evaluate(x, term_values_);
  term_moments_.add(term_values_);
}

double ScaleTracker::mean_target() const {
  return target_moments_.count() > 0 ? target_moments_.mean()[0] : 0.0;
}

const AxisScaling* ScaleTracker::next() {
  const bool wanted = !on_the_way() && (!scaling_ || outgrown(*scaling_));
  return wanted && measure() ? &next_ : nullptr;
}

void ScaleTracker::adopt() {
  if (scaling_) {
    std::swap(*scaling_, next_);
  } else {
    scaling_ = next_;
  }
  move_ = move_ == Move::coming ? Move::adopted : Move::none;
}

bool ScaleTracker::measure() {
  const double variance = target_moments_.covariance(0, 0);
  if (!next_.input.take(input_moments_, kind_) || !(variance > 0.0)) {
    return false;
  }
  next_.target = {mean_target(), std::sqrt(variance)};
  terms_.scales(input_moments_, term_moments_, next_.term_scale);
  return true;
}

bool ScaleTracker::outgrown(const AxisScaling& scaling) const {
  if (!counts() || (observed_ % kScaleTuning.look_every != 0 && !far_)) {
    return false;
  }
  const double target = std::sqrt(target_moments_.covariance(0, 0)) / scaling.target.scale;
  return std::max(scaling.input.growth(input_moments_), target) > track_;
}

void ScaleTracker::amplify(const CommandGain& gain) {
  const auto [input, factor] = gain;
  if (factor == 1.0) {
    return;
  }
  const auto apply = [&](AxisScaling& scaling) {
    scaling.input.mean[input] /= factor;
    for (std::size_t row = 0; row < inputs_; ++row) {
      scaling.input.whitening(row, input) *= factor;
    }
    for (std::size_t k = 0; k < terms_.size(); ++k) {
      scaling.term_scale[k] /= term_gain(terms_, k, {&gain, 1});
    }
  };
  apply(*scaling_);  // NOLINT(bugprone-unchecked-optional-access): required
  if (on_the_way()) {
    apply(next_);
  }
}

SampleMap ScaleTracker::map() const {
  return [this](std::span<double> x, double& y) {
    const AxisScaling& in_use = *scaling_;  // NOLINT(bugprone-unchecked-optional-access): required
    const bool adopted = move_ == Move::adopted;
    const AxisScaling& now = adopted ? next_ : in_use;
    const AxisScaling& next = adopted ? in_use : next_;
    const ScaledInput raw = now.input.invert(x.first(inputs_));
    const ScaledInput z = next.input.apply(as_span(raw));
    std::ranges::copy(z, x.begin());
    for (std::size_t k = 0; k < terms_.size(); ++k) {
      x[inputs_ + k] *= now.term_scale[k] / next.term_scale[k];
    }
    y = next.target.apply(now.target.invert(y));
  };
}

void ScaleTracker::visit(Archive& archive) {
  archive.same("scales", given_ ? "given" : "from the first samples");
  archive.whole(observed_);
  archive.part("moments", input_moments_);
  archive.part("target_moments", target_moments_);
  archive.part("term_moments", term_moments_);
  archive.numbers(largest_);
  bool known = scaling_.has_value();
  archive.flag(known);
  archive.require(known || !given_, "lacks the scaling it was given");
  if (archive.loading() && known) {
    scaling_.emplace();
  }
  if (scaling_) {
    archive.part("scaling", *scaling_, inputs_, terms_.size());
  }
  archive.choice(move_, Move{}, Move::adopted);
  archive.require(known || !on_the_way(), "is on the way from no scale");
  if (on_the_way()) {
    archive.part("other scaling", next_, inputs_, terms_.size());
  }
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
