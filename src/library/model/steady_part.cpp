// SPDX-License-Identifier: Apache-2.0
#include "model/steady_part.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
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

// The standard deviation of the integral of such a process over a time.
double integrated(double deviation, double time_s, double age_s) {
  const double ages = time_s > 0.0 ? age_s / time_s : 0.0;
  return deviation * time_s * std::sqrt(std::max(2.0 * (ages - 1.0 + std::exp(-ages)), 0.0));
}

}  // namespace

double SteadyModel::acceleration(std::span<const double> phi) const {
  return as_vector(std::span(weights).first(phi.size())).dot(as_vector(phi)) + weights.back();
}

void SteadyPart::Errors::add(double error, std::int64_t count) {
  average(square, error * error, count);
  if (!std::isnan(last)) {
    average(lagged, error * last, count);
  }
  before = std::exchange(last, error);
}

void SteadyPart::Errors::visit(Archive& archive) {
  archive.any_number(last);
  archive.any_number(before);
  archive.number(square);
  archive.number(lagged);
}

void SteadyPart::Window::clear() {
  std::ranges::fill(y, 0.0);
  std::ranges::fill(phi, 0.0);
  for (Errors& one : errors) {
    one.last = one.before = std::numeric_limits<double>::quiet_NaN();
  }
}

void SteadyPart::Window::visit(Archive& archive) {
  archive.numbers(y);
  archive.numbers(phi);
  for (Errors& one : errors) {
    one.visit(archive);
  }
}

double SteadyPart::Axis::error_time_s() const {
  return error_square > 0.0 ? correlation_time(block_square, error_square) : 0.0;
}

SteadyPart::SteadyPart(TermSet terms, std::size_t inputs, std::vector<std::size_t> states,
                       AttitudeMotion attitude)
    : terms_(std::move(terms)),
      states_(std::move(states)),
      seen_(inputs),
      axes_(states_.size()),
      fit_(terms_.size() + 1, kSteady.prior, states_.size()),
      window_(states_.size(), fit_.terms()),
      twice_(window_),
      raw_(fit_.terms()),
      phi_(fit_.terms(), 1.0),
      next_(phi_),
      x_sum_(inputs),
      y_sum_(states_.size()),
      x_(inputs),
      y_(states_.size()),
      velocity_(states_.size()),
      x_last_(inputs),
      y_last_(states_.size()),
      practice_(inputs, states_, std::move(attitude)),
      weights_(fit_.terms() * states_.size()),
      held_(fit_),
      scratch_(phi_) {
  break_off();
}

double SteadyPart::window_s() const {
  return gain_ < 1.0 ? -0.5 * usual_step_s_ / std::log1p(-gain_) : 0.0;
}

void SteadyPart::observe(std::span<const double> x, std::span<const double> y, double t,
                         const Accelerations& learned) {
  if (samples_ > 0 && !joins(x, y, t - last_s_)) {
    close_step(learned);
    break_off();
  } else if (count_ > 0 && t - begin_s_ >= kModelTuning.almost * kSteady.step_s) {
    close_step(learned);
  }
  ++samples_;
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    Extremes& range = seen_[i];
    range = samples_ > 1 ? Extremes{std::min(range.low, x[i]), std::max(range.high, x[i])}
                         : Extremes{x[i], x[i]};
  }
  for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
    average(axes_[axis].target_square, y[axis] * y[axis], samples_);
  }
  begin_s_ = count_ == 0 ? t : begin_s_;
  as_vector(x_sum_) += as_vector(x);
  as_vector(y_sum_) += as_vector(y);
  t_sum_ += t - begin_s_;
  ++count_;
  x_last_.assign(x.begin(), x.end());
  y_last_.assign(y.begin(), y.end());
  last_s_ = t;
}

// Whether a sample goes on from the one before: no gap in time, and no cut.
bool SteadyPart::joins(std::span<const double> x, std::span<const double> y, double step_s) {
  if (usual_sample_s_ == 0.0) {
    usual_sample_s_ = step_s;
  }
  const double longest = kLongestStep * usual_sample_s_;
  average(usual_sample_s_, std::min(step_s, longest), samples_);
  if (step_s > longest) {
    return false;
  }
  bool joined = true;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    Axis& axis = axes_[i];
    const double change = x[states_[i]] - x_last_[states_[i]] - 0.5 * step_s * (y_last_[i] + y[i]);
    const double usual = kSteady.jump * kSteady.jump * axis.target_square * step_s * step_s;
    const double noisy = kSteady.noisy_jump * kSteady.noisy_jump * axis.noise_square;
    joined = joined && change * change <= std::max(usual, noisy);
    const double told = kSteady.clip * kSteady.clip * axis.noise_square;
    average(axis.noise_square,
            told > 0.0 ? std::min(change * change, std::max(told, usual)) : change * change,
            samples_);
  }
  return joined;
}

void SteadyPart::break_off() {
  joined_ = false;
  window_.clear();
  twice_.clear();
  block_s_ = 0.0;
  for (Axis& axis : axes_) {
    axis.block_sum = 0.0;
  }
  practice_.break_off();
}

// The samples of a step become one.
void SteadyPart::close_step(const Accelerations& learned) {
  const auto samples = static_cast<double>(count_);
  as_vector(x_) = as_vector(x_sum_) / samples;
  as_vector(y_) = as_vector(y_sum_) / samples;
  const double now = begin_s_ + t_sum_ / samples;
  std::ranges::fill(x_sum_, 0.0);
  std::ranges::fill(y_sum_, 0.0);
  t_sum_ = 0.0;
  count_ = 0;
  terms_.evaluate(x_, {next_.data(), terms_.size()});
  const double step_s = joined_ ? now - time_s_ : 0.0;
  if (step_s > 0.0) {
    if (usual_step_s_ == 0.0) {
      usual_step_s_ = step_s;
    }
    average(usual_step_s_, step_s, fit_.rows() + 1);
    learn_errors(step_s);
    learn_step(step_s);
  }
  practise(learned);
  std::swap(phi_, next_);
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    velocity_[i] = x_[states_[i]];
  }
  time_s_ = now;
  joined_ = true;
}

void SteadyPart::learn_step(double step_s) {
  const double keep = std::pow(1.0 - gain_, step_s / usual_step_s_);
  slide(window_, keep * keep, step_s);
  slide(twice_, keep, step_s);
  fit_.add(window_.phi, window_.y);
  const auto rows = static_cast<double>(fit_.rows());
  as_vector(raw_).array() += (as_vector(phi_).array().square() - as_vector(raw_).array()) / rows;
  if (known()) {
    match_window();
  }
}

void SteadyPart::slide(Window& window, double keep, double step_s) {
  as_vector(window.phi) =
      keep * as_vector(window.phi) + 0.5 * step_s * (as_vector(phi_) + as_vector(next_));
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    window.y[i] = keep * window.y[i] + x_[states_[i]] - velocity_[i];
    if (known()) {
      window.errors[i].add(window.y[i] - as_vector(fit_.theta(i)).dot(as_vector(window.phi)),
                           errors_);
    }
  }
}

// By the gradient that a single error gives: stochastic approximation (Robbins & Monro 1951).
void SteadyPart::match_window() {
  const auto least = std::ranges::min_element(twice_.errors, {}, &Errors::correlation);
  if (!std::isnan(least->before) && least->square > 0.0) {
    const double told =
        std::clamp(least->last * least->before / least->square, -kSteady.clip, kSteady.clip);
    const double slowest = -std::expm1(-usual_step_s_ / kSteady.longest_window_s);
    gain_ = std::clamp(gain_ * std::exp(kSteady.match * told), std::min(slowest, 1.0), 1.0);
  }
}

void SteadyPart::learn_errors(double step_s) {
  if (!known() && fit_.rows() < kSteady.steps_per_term * static_cast<std::int64_t>(fit_.terms())) {
    return;
  }
  ++errors_;
  block_s_ += step_s;
  const bool full = block_s_ >= kSteady.block_s;
  blocks_ += full ? 1 : 0;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    Axis& axis = axes_[i];
    // Nobody is off by more than twice what there is to be known, but for a moment.
    const double most = 2.0 * std::sqrt(axis.target_square);
    const double error =
        std::clamp(y_[i] - as_vector(fit_.theta(i)).dot(as_vector(next_)), -most, most);
    average(axis.error_square, error * error, errors_);
    axis.block_sum += error * step_s;
    if (full) {
      const double mean = axis.block_sum / block_s_;
      average(axis.block_square, mean * mean, blocks_, kSteady.block_memory);
      axis.block_sum = 0.0;
    }
  }
  block_s_ = full ? 0.0 : block_s_;
}

// As a rollout goes: from a sample, compared with samples.
void SteadyPart::practise(const Accelerations& learned) {
  const double step_s = last_s_ - practised_s_;
  practised_s_ = last_s_;
  if (!known() || !learned) {
    practice_.break_off();
    return;
  }
  if (practice_.running() && step_s > 0.0) {
    const Accelerations steady = [this](std::span<const double> x, std::span<double> a) {
      terms_.evaluate(x, {scratch_.data(), terms_.size()});
      for (std::size_t i = 0; i < a.size(); ++i) {
        a[i] = as_vector(std::span(weights_).subspan(i * scratch_.size(), scratch_.size()))
                   .dot(as_vector(scratch_));
      }
    };
    practice_.go_on(x_last_, step_s, steady, learned, seen_);
  }
  if (!practice_.running()) {
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      held_ = fit_;
      hold_products(held_, i);
      std::ranges::copy(held_.theta(i),
                        weights_.begin() + static_cast<std::ptrdiff_t>(i * fit_.terms()));
    }
    practice_.begin(x_last_);
  }
}

void SteadyPart::restart() {
  break_off();
  practice_.restart();
  errors_ = std::min(errors_, kSteady.few);
  if (known()) {
    const double rows = std::ceil(kSteady.before_s / std::max(usual_step_s_, kSteady.step_s));
    fit_.limit_rows(static_cast<std::int64_t>(rows));
    blocks_ = 1;
  } else {
    fit_.clear();
    samples_ = 0;
    count_ = 0;
    errors_ = 0;
    t_sum_ = 0.0;
    std::ranges::fill(x_sum_, 0.0);
    std::ranges::fill(y_sum_, 0.0);
  }
}

void SteadyPart::amplify(std::span<const CommandGain> gains) {
  std::ranges::fill(scratch_, 1.0);
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    scratch_[k] = 1.0 / term_gain(terms_, k, gains);
  }
  fit_.rescale(scratch_);
}

// As a number of rows: the variance of a row's error over that of what a product makes up in the
// row. Errors that last are as many fewer.
void SteadyPart::hold_products(TriangularFit& fit, std::size_t axis) const {
  const double product = kSteady.products * kSteady.products * axes_[axis].target_square;
  const Errors& errors = window_.errors[axis];
  const double alike = std::clamp(errors.correlation(), 0.0, kSteady.most_alike);
  const double error = errors.square * (1.0 + alike) / (1.0 - alike);
  for (std::size_t k = terms_.without_products(); k < terms_.size(); ++k) {
    if (product > 0.0 && fit_.moments()[k] > 0.0) {
      fit.hold(k, error / product * raw_[k] / fit_.moments()[k]);
    }
  }
}

void SteadyPart::visit(Archive& archive) {
  for (Extremes& range : seen_) {
    archive.number(range.low);
    archive.number(range.high);
  }
  for (Axis& axis : axes_) {
    for (double* const number : {&axis.target_square, &axis.error_square, &axis.block_square,
                                 &axis.block_sum, &axis.noise_square}) {
      archive.number(*number);
    }
  }
  archive.part("fit", fit_);
  window_.visit(archive);
  twice_.visit(archive);
  for (std::vector<double>* const numbers :
       {&raw_, &phi_, &x_sum_, &y_sum_, &x_, &y_, &velocity_, &x_last_, &y_last_, &weights_}) {
    archive.numbers(*numbers);
  }
  for (double* const number : {&gain_, &t_sum_, &begin_s_, &time_s_, &usual_step_s_, &last_s_,
                               &usual_sample_s_, &block_s_, &practised_s_}) {
    archive.number(*number);
  }
  archive.flag(joined_);
  for (std::int64_t* const count : {&count_, &errors_, &blocks_, &samples_}) {
    archive.whole(*count);
  }
  archive.part("practice", practice_);
}

SteadyModel SteadyPart::model(std::size_t axis) const {
  SteadyModel model;
  model.state = states_[axis];
  if (!known()) {
    return model;
  }
  TriangularFit held = fit_;
  hold_products(held, axis);
  model.weights.assign(held.theta(axis).begin(), held.theta(axis).end());
  model.share = practice_.share(axis);
  model.seen = seen_;
  model.error = std::sqrt(axes_[axis].error_square);
  model.error_time_s = axes_[axis].error_time_s();
  model.noise = std::sqrt(0.5 * axes_[axis].noise_square);  // a change has noise at both its ends
  model.kept = practice_.kept(axis);
  model.off = practice_.off(axis);
  for (std::size_t age = 0; age < model.off.size(); ++age) {
    double& off = model.off[age];
    if (std::isnan(off)) {
      off =
          std::hypot(model.noise, integrated(model.error, model.error_time_s, kPractisedAges[age]));
    } else {  // the error of the true velocity: without the noise of the sample at the end
      const double least = kModelTuning.practice.least_off * off;
      off = std::sqrt(std::max(off * off - model.noise * model.noise, least * least));
    }
  }
  return model;
}

}  // namespace kelpie
