// SPDX-License-Identifier: Apache-2.0
#include "model/change_start.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/eigen.hpp"
#include "model/tuning.hpp"

namespace kelpie {
namespace {

constexpr const auto& kStart = kModelTuning.change;
constexpr double kHuber = kStart.huber;
constexpr LoneCause kUnknown{.variance = kStart.deviation * kStart.deviation};

// With tails of Huber's (1964) loss.
double robust_log_density(double error, double variance) {
  const double deviations = std::abs(error) / std::sqrt(variance);
  const double square =
      deviations <= kHuber ? deviations * deviations : kHuber * (2.0 * deviations - kHuber);
  return -0.5 * (square + std::log(variance));
}

// An error of `left`, of noise and of a size with the effect `unit`, tells of the size (Kalman
// 1960).
void update_size(LoneCause& one, double unit, double left, double noise, double tau) {
  const double spread = unit * unit * one.variance;
  const double weight = robust_weight(left, noise + spread) / tau;
  const double gain = one.variance * unit / (noise / weight + spread);
  one.size += gain * left;
  one.variance *= 1.0 - gain * unit;
}

double log_density(double error, double variance) {
  return -0.5 * (error * error / variance + std::log(variance));
}

}  // namespace

double robust_weight(double error, double variance) {
  const double far = kHuber * kHuber * variance;
  return error * error > far ? far / (error * error) : 1.0;
}

void LoneCause::visit(Archive& archive) {
  for (double* const number : {&size, &variance, &likelihood}) {
    archive.number(*number);
  }
}

void CommandEffect::add(const CauseEffects& effects, std::size_t command, double weight) {
  const double square = effects.square[command];
  const double linear = effects.of_cause[command] - square;
  ll += weight * linear * linear;
  lq += weight * linear * square;
  qq += weight * square * square;
}

double CommandEffect::gain(double size) const {
  double best = 1.0;
  double least = std::numeric_limits<double>::infinity();
  for (double g = kStart.least_gain; g <= kStart.most_gain; g += kStart.gain_step) {
    const double linear = g - 1.0 - size;
    const double square = g * g - 1.0 - size;
    const double error = linear * linear * ll + 2.0 * linear * square * lq + square * square * qq;
    if (error < least) {
      least = error;
      best = g;
    }
  }
  return best;
}

void CommandEffect::visit(Archive& archive) {
  for (double* const number : {&ll, &lq, &qq}) {
    archive.number(*number);
  }
}

ChangeStart::ChangeStart(std::size_t commands, std::size_t axes, std::size_t coefficients)
    : theta(coefficients),
      size(commands + 2 * axes),
      covariance(size.size() * size.size()),
      lone(size.size() + kCausesOfMany),
      constant(axes),
      scatter(axes),
      tau(axes),
      effect(commands),
      gain_(size.size()) {}

void ChangeStart::begin(double t, double life) {
  alive = true;
  begun_s = t;
  life_s = life;
  evidence = 0.0;
  over_constant = 0.0;
  samples = 0.0;
  peak = 0.0;
  likelihood = 0.0;
  std::ranges::fill(size, 0.0);
  std::ranges::fill(covariance, 0.0);
  std::ranges::fill(lone, kUnknown);
  std::ranges::fill(effect, CommandEffect{});
  for (std::size_t a = 0; a < constant.size(); ++a) {
    constant[a] = unknown_constant(a);
  }
}

void ChangeStart::expect_all_causes() {
  for (std::size_t c = 0; c < size.size(); ++c) {
    covariance[c * (size.size() + 1)] = kUnknown.variance;
  }
}

void ChangeStart::expect_cause(std::size_t cause, double believed, double variance) {
  size[cause] = believed;
  covariance[cause * (size.size() + 1)] = variance;
  lone[cause] = {.size = believed, .variance = variance, .likelihood = kStart.enough};
}

// As observe() with one size alone; `error`: of the vehicle before, `unchanged`: the log density of
// no change. A size that explains less than no change begins anew (CUSUM: Page 1954), and so at the
// change.
void ChangeStart::observe_lone(std::size_t axis, const CauseEffects& effects, double error,
                               double noise, double unchanged) {
  for (std::size_t k = 0; k < lone.size(); ++k) {
    LoneCause& one = lone[k];
    const double unit = effects.of_cause[k];
    const double left = error - unit * one.size;
    const double variance = noise + unit * unit * one.variance;
    one.likelihood += (robust_log_density(left, variance) - unchanged) / tau[axis];
    update_size(one, unit, left, noise, tau[axis]);
    if (one.likelihood <= 0.0) {
      one = kUnknown;
    }
  }
}

LoneCause ChangeStart::unknown_constant(std::size_t axis) const {
  const double deviation = kStart.constant_errors * scatter[axis];
  return {.variance = deviation * deviation};
}

// The log density of an error that is constant but for noise, or `unchanged`, of no error but
// noise, where larger. A constant that explains less than no error begins anew, and so at a new
// speed.
double ChangeStart::constant_log_density(std::size_t axis, double error, double noise,
                                         double unchanged) {
  LoneCause& one = constant[axis];
  const double left = error - one.size;
  const double variance = noise + one.variance;
  update_size(one, 1.0, left, noise, tau[axis]);
  const double density = log_density(left, variance);
  one.likelihood += (density - unchanged) / tau[axis];
  if (one.likelihood <= 0.0) {
    one = unknown_constant(axis);
  }
  return std::max(density, unchanged);
}

void ChangeStart::observe(std::size_t axis, const CauseEffects& effects, double y, double without,
                          double spread) {
  auto sizes_covariance = columns_of(std::span<double>(covariance), size.size());
  auto gain = as_vector(gain_);
  const auto unit = as_vector(std::span<const double>(effects.of_cause).first(size.size()));
  const double noise = scatter[axis] * scatter[axis] * spread;
  gain.noalias() = sizes_covariance * unit;
  const double unknown = unit.dot(gain);
  const double error = y - effects.value - unit.dot(as_vector(size));
  const double unchanged = robust_log_density(without, noise);
  observe_lone(axis, effects, y - effects.value, noise, unchanged);
  for (std::size_t c = 0; c < effect.size(); ++c) {
    effect[c].add(effects, c, 1.0 / noise);
  }
  likelihood += (robust_log_density(error, noise + unknown) - unchanged) / tau[axis];
  const double changed = log_density(error, noise + unknown);
  const auto gained_over = [&](double other) {
    return std::clamp(changed - other, -kStart.clip_nats, kStart.clip_nats) / tau[axis];
  };
  const double without_change = log_density(without, noise);
  evidence += gained_over(without_change);
  over_constant = std::max(
      0.0, over_constant + gained_over(constant_log_density(axis, without, noise, without_change)));
  samples += 1.0 / tau[axis];
  const double weight = robust_weight(error, noise + unknown) / tau[axis];
  const double scale = 1.0 / (noise / weight + unknown);
  as_vector(size) += (scale * error) * gain;
  for (Eigen::Index c = 0; c < gain.size(); ++c) {
    sizes_covariance.col(c) -= (scale * gain(c)) * gain;
  }
}

// Of a cause in the order of `lone`: one size, or as many as there are causes alike.
std::span<double> ChangeStart::sizes_of(std::size_t cause, std::span<double> sizes) const {
  const std::size_t axes = scatter.size();
  const std::size_t commands = effect.size();
  if (cause < size.size()) {
    return sizes.subspan(cause, 1);
  }
  const std::size_t alike = cause - size.size();  // drag, inertia, commands
  return alike < 2 ? sizes.subspan(commands + alike * axes, axes) : sizes.first(commands);
}

void ChangeStart::mix_sizes(std::span<double> sizes) const {
  const double most =
      std::max(likelihood, std::ranges::max_element(lone, {}, &LoneCause::likelihood)->likelihood);
  double sum = std::exp(likelihood - most);
  as_vector(sizes) = sum * as_vector(std::span<const double>(size));
  for (std::size_t k = 0; k < lone.size(); ++k) {
    const double weight = std::exp(lone[k].likelihood - most);
    for (double& one : sizes_of(k, sizes)) {
      one += weight * lone[k].size;
    }
    sum += weight;
  }
  as_vector(sizes) /= sum;
}

void ChangeStart::visit(Archive& archive) {
  archive.flag(alive);
  if (!alive) {
    return;
  }
  for (double* const number :
       {&begun_s, &life_s, &evidence, &over_constant, &samples, &peak, &likelihood}) {
    archive.number(*number);
  }
  std::ranges::for_each(constant, [&](LoneCause& one) { one.visit(archive); });
  for (std::vector<double>* const values : {&theta, &size, &covariance, &scatter, &tau}) {
    archive.numbers(*values);
  }
  std::ranges::for_each(effect, [&](CommandEffect& one) { one.visit(archive); });
  std::ranges::for_each(lone, [&](LoneCause& one) { one.visit(archive); });
}

}  // namespace kelpie
