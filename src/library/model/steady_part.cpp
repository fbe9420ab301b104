// SPDX-License-Identifier: Apache-2.0
#include "model/steady_part.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/eigen.hpp"
#include "core/seconds.hpp"
#include "model/tuning.hpp"

namespace kelpie {
namespace {

constexpr const auto& kSteady = kModelTuning.steady;

// A mean that fades over `memory` values. As long as there are fewer, a value counts the more the
// later it came, since the first steps are taken blindly.
void average(double& mean, double value, std::int64_t count, double memory = kSteady.memory) {
  const double weight = std::max(2.0 / (static_cast<double>(count) + 1.0), 1.0 / memory);
  mean += weight * (value - mean);
}

// The correlation time τ of a first-order Gauss-Markov process of variance v whose means over
// blocks of length T have the variance m: m = 2 v τ/T (1 − τ/T (1 − e^(−T/τ))).
double correlation_time(double m, double v) {
  const double random_walk = 0.5 * kSteady.block_s * m / v;
  double time_s = random_walk;
  for (int i = 0; i < 20 && time_s > 0.0; ++i) {
    const double share = time_s / kSteady.block_s;
    time_s =
        std::min(random_walk / (1.0 - share * (1.0 - std::exp(-1.0 / share))), kSteady.block_s);
  }
  return time_s;
}

}  // namespace

double SteadyModel::acceleration(std::span<const double> phi) const {
  return as_vector(std::span(weights).first(phi.size())).dot(as_vector(phi)) + weights.back();
}

SteadyPart::SteadyPart(TermSet terms, std::size_t inputs, std::size_t state)
    : terms_(std::move(terms)),
      state_(state),
      seen_(inputs),
      fit_(terms_.size() + 1, kSteady.prior),
      phi_(fit_.terms(), 1.0),
      next_(phi_) {}

void SteadyPart::observe(std::span<const double> x, double y, double t) {
  terms_.evaluate(x, {next_.data(), terms_.size()});
  if (known() || fit_.rows() >= kSteady.least_steps) {
    learn_error(y - as_vector(fit_.theta()).dot(as_vector(next_)),
                samples_ > 0 ? t - time_s_ : 0.0);
  }
  const double step_s = t - time_s_;
  if (samples_ > 0 && step_s > 0.0) {
    learn_step(x[state_] - velocity_, y, step_s);
  }
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    Extremes& range = seen_[i];
    range = samples_ > 0 ? Extremes{std::min(range.low, x[i]), std::max(range.high, x[i])}
                         : Extremes{x[i], x[i]};
  }
  average(target_square_, y * y, ++samples_);
  phi_ = next_;
  velocity_ = x[state_];
  target_ = y;
  time_s_ = t;
}

void SteadyPart::learn_step(double change, double y, double step_s) {
  if (usual_step_s_ == 0.0) {
    usual_step_s_ = step_s;
  }
  const double longest = kLongestStep * usual_step_s_;
  average(usual_step_s_, std::min(step_s, longest), samples_);
  const double jump = change / step_s - 0.5 * (target_ + y);
  if (step_s <= longest && jump * jump <= kSteady.jump * kSteady.jump * target_square_) {
    as_vector(phi_) = 0.5 * (as_vector(phi_) + as_vector(next_));
    fit_.add(phi_, change / step_s);
    average(noise_square_, jump * jump * step_s * step_s, fit_.rows());
  }
}

// Nobody is off by more than twice what there is to be known, but for a moment.
void SteadyPart::learn_error(double error, double step_s) {
  const double most = 2.0 * std::sqrt(target_square_);
  const double counted = std::clamp(error, -most, most);
  average(error_square_, counted * counted, ++errors_);
  if (step_s > kLongestStep * usual_step_s_) {
    block_s_ = block_sum_ = 0.0;
    return;
  }
  block_sum_ += counted * step_s;
  block_s_ += step_s;
  if (block_s_ >= kSteady.block_s) {
    const double mean = block_sum_ / block_s_;
    average(block_square_, mean * mean, ++blocks_, kSteady.block_memory);
    block_s_ = block_sum_ = 0.0;
  }
}

void SteadyPart::observe_learned(double error) {
  average(learned_square_, error * error, ++learned_);
}

void SteadyPart::restart() {
  block_s_ = block_sum_ = 0.0;
  errors_ = std::min(errors_, kSteady.few);
  learned_ = std::min(learned_, kSteady.few);
  if (known()) {
    fit_.limit_rows(kSteady.before);
    blocks_ = 1;
  } else {
    fit_.clear();
    samples_ = 0;
  }
}

void SteadyPart::visit(Archive& archive) {
  for (Extremes& range : seen_) {
    archive.number(range.low);
    archive.number(range.high);
  }
  archive.part("fit", fit_);
  archive.numbers(phi_);
  for (double* number :
       {&velocity_, &target_, &time_s_, &usual_step_s_, &target_square_, &error_square_,
        &block_square_, &block_sum_, &block_s_, &noise_square_, &learned_square_}) {
    archive.number(*number);
  }
  archive.whole(learned_);
  archive.whole(errors_);
  archive.whole(blocks_);
  archive.whole(samples_);
}

// How long an error lasts.
double SteadyPart::error_time_s() const {
  return error_square_ > 0.0 ? correlation_time(block_square_, error_square_) : 0.0;
}

// As a number of steps: the variance of an error over that of what a product makes up. Errors that
// last are as many fewer.
double SteadyPart::prior_of_products() const {
  const double usual = kSteady.products * kSteady.products * target_square_;
  const double alike = 1.0 + 2.0 * error_time_s() / usual_step_s_;
  return usual > 0.0 ? alike * error_square_ / usual : 0.0;
}

SteadyModel SteadyPart::model() const {
  SteadyModel model;
  model.state = state_;
  if (known()) {
    TriangularFit held = fit_;
    for (std::size_t k = terms_.without_products(); k < terms_.size(); ++k) {
      held.hold(k, prior_of_products());
    }
    model.weights.assign(held.theta().begin(), held.theta().end());
    model.seen = seen_;
    model.error = std::sqrt(error_square_);
    model.learned_error = std::sqrt(learned_square_);
    model.noise = std::sqrt(0.5 * noise_square_);  // a step has noise at both its ends
    model.error_time_s = error_time_s();
  }
  return model;
}

}  // namespace kelpie
