// SPDX-License-Identifier: Apache-2.0
#include "model/change_monitor.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>

#include "core/eigen.hpp"
#include "learner/tuning.hpp"
#include "model/tuning.hpp"

namespace kelpie {
namespace {

constexpr const auto& kChange = kModelTuning.change;
constexpr double kHuber = kOnline.members.huber;  // as the members, which follow the monitor
constexpr double kKept = kOnline.members.kept;
constexpr double kBefore = -std::numeric_limits<double>::infinity();  // of all times [s]

std::size_t used_terms(const TermSet& terms) {
  return terms.size() <= kChange.most_terms ? terms.size()
                                            : std::min(terms.without_products(), terms.size());
}

// Errors beyond 2.5 of their standard deviations count less.
double robust_weight(double error, double variance) {
  const double far = kHuber * kHuber * variance;
  return error * error > far ? far / (error * error) : 1.0;
}

// With tails of Huber's (1964) loss.
double robust_log_density(double error, double variance) {
  const double deviations = std::abs(error) / std::sqrt(variance);
  const double square =
      deviations <= kHuber ? deviations * deviations : kHuber * (2.0 * deviations - kHuber);
  return -0.5 * (square + std::log(variance));
}

double log_density(double error, double variance) {
  return -0.5 * (error * error / variance + std::log(variance));
}

}  // namespace

const ChangeMonitor::Lone ChangeMonitor::kUnknown{.variance =
                                                      kChange.deviation * kChange.deviation};

ChangeMonitor::ChangeMonitor(const TermSet& terms, std::span<const std::size_t> states,
                             std::span<const std::size_t> commands)
    : terms_(terms),
      commands_(commands.size()),
      term_commands_(used_terms(terms)),
      term_drag_(used_terms(terms), states.size()),
      fit_(used_terms(terms) + 1, kChange.prior, states.size()),
      scatter_(states.size(), RobustScale(kChange.least_errors, kChange.scatter_every)),
      correlation_(states.size()),
      starts_(kMostStarts),
      changed_start_(kMostStarts),
      gained_(commands.size()),
      believed_s_(kBefore),
      row_s_(kBefore),
      begun_s_(kBefore),
      told_(columns() * axes()),
      step_(told_),
      all_phi_(terms.size()),
      phi_(columns()),
      weighted_y_(axes()),
      error_(axes()),
      effect_(causes()),
      gain_(causes()),
      mixed_(causes()),
      told_gains_(commands.size(), 1.0),
      usual_effect_(commands.size()),
      square_(commands.size()) {
  for (const std::size_t command : commands) {
    gains_.push_back({.input = command});
    bool scales = true;
    for (std::size_t k = 0; k < terms.size(); ++k) {
      scales = scales && std::isfinite(terms.power(k, command));
    }
    scales_.push_back(scales);
  }
  for (std::size_t k = 0; k < term_commands_.size(); ++k) {
    const std::span<const std::size_t> inputs = terms.term(k).columns();
    for (std::size_t c = 0; c < commands.size(); ++c) {
      if (std::ranges::find(inputs, commands[c]) != inputs.end()) {
        term_commands_[k].push_back({c, terms.power(k, commands[c])});
      }
    }
    if (inputs.size() == 1) {
      term_drag_[k] =
          static_cast<std::size_t>(std::ranges::find(states, inputs[0]) - states.begin());
    }
  }
  for (Start& start : starts_) {
    start.theta.resize(told_.size());
    start.size.resize(causes());
    start.covariance.resize(causes() * causes());
    start.lone.resize(causes() + 2);
    start.scatter.resize(axes());
    start.tau.resize(axes());
    start.effect.resize(commands_);
  }
}

ChangeMonitor::Event ChangeMonitor::update(std::span<const double> x, std::span<const double> y,
                                           double t) {
  if (t - row_s_ < kChange.step_s) {
    return Event::none;
  }
  row_s_ = t;
  terms_.evaluate(x, all_phi_);
  std::ranges::copy(std::span(all_phi_).first(columns() - 1), phi_.begin());
  phi_.back() = 1.0;
  predict(y);
  if (changed_start_ < kMostStarts) {
    return follow(y, t);
  }
  end_old_starts(t);
  if (std::isfinite(leverage_)) {
    for (Start& start : starts_) {
      if (start.alive) {
        observe(start, y, true);
      }
    }
  }
  const Start* const likely = most_evident();
  if (likely != nullptr && likely->evidence > threshold()) {
    Start& start = youngest_with(kChange.alike * likely->evidence);
    if (start.evidence > kChange.clear * start.samples) {
      return believe(start, t);
    }
  }
  learn(y);
  begin_start(t);
  return Event::none;
}

// The errors of the fit, and how certain the fit is.
void ChangeMonitor::predict(std::span<const double> y) {
  leverage_ = fit_.leverage(phi_);
  for (std::size_t a = 0; a < axes(); ++a) {
    error_[a] = y[a] - as_vector(fit_.theta(a)).dot(as_vector(phi_));
  }
}

// A fit of few samples per coefficient is not a vehicle that is known.
bool ChangeMonitor::known() const {
  return samples_ >= kChange.samples_per_term * static_cast<double>(columns());
}

double ChangeMonitor::threshold() const {
  return std::max(kChange.enough, kChange.over_usual * usual_);
}

// One weight for all axes, since all axes share the factor of the fit.
double ChangeMonitor::row_weight() const {
  double weight = 1.0;
  double tau = 1.0;
  for (std::size_t a = 0; a < axes(); ++a) {
    tau = std::max(tau, correlation_[a].rows_per_sample());
    const double scatter = scatter_[a].value();
    if (std::isfinite(scatter) && std::isfinite(leverage_)) {
      weight = std::min(weight, robust_weight(error_[a], scatter * scatter * (1.0 + leverage_)));
    }
  }
  return weight / tau;
}

void ChangeMonitor::learn(std::span<const double> y) {
  const double weight = row_weight();
  ++rows_;
  samples_ += weight;
  for (std::size_t a = 0; std::isfinite(leverage_) && a < axes(); ++a) {
    const double error = error_[a] / std::sqrt(1.0 + leverage_);
    if (rows_ % kChange.error_every == 0) {
      scatter_[a].add(error);
    }
    const double most = kChange.clip_errors * scatter_[a].value();
    if (std::isfinite(most)) {
      correlation_[a].add(std::clamp(error, -most, most));
    }
  }
  for (std::size_t a = 0; errors_known() && a < axes(); ++a) {
    effects(fit_.theta(a), a);
    for (std::size_t c = 0; c < commands_; ++c) {
      usual_effect_[c].add(effect_[c] - square_[c], square_[c],
                           weight / (scatter_[a].value() * scatter_[a].value()));
    }
  }
  const double root = std::sqrt(weight);
  as_vector(phi_) *= root;
  std::ranges::transform(y, weighted_y_.begin(), [root](double value) { return root * value; });
  fit_.add(phi_, weighted_y_);
}

bool ChangeMonitor::errors_known() const {
  return std::ranges::all_of(scatter_, [](const RobustScale& scatter) {
    return std::isfinite(scatter.value()) && scatter.value() > 0.0;
  });
}

// Every second start lives twice as long as the others, every fourth four times, and so on: starts
// of all ages up to ten minutes, the young ones close together. A start with the coefficients of a
// vehicle that is not known yet would take what is learned of the vehicle for a change.
void ChangeMonitor::begin_start(double t) {
  const auto free = std::ranges::find(starts_, false, &Start::alive);
  if (t - begun_s_ < kChange.start_every_s || free == starts_.end() || !known() ||
      !errors_known()) {
    return;
  }
  begun_s_ = t;
  ++begun_;
  const int doublings = std::min(std::countr_zero(begun_), kChange.doublings);
  free->begin(t, kChange.life_s * static_cast<double>(1 << doublings));
  std::ranges::copy(fit_.theta(), free->theta.begin());
  for (std::size_t c = 0; c < causes(); ++c) {
    free->covariance[c * (causes() + 1)] = kChange.deviation * kChange.deviation;
  }
  expect_usual_errors(*free);
}

void ChangeMonitor::Start::begin(double t, double life) {
  alive = true;
  begun_s = t;
  life_s = life;
  evidence = 0.0;
  samples = 0.0;
  peak = 0.0;
  likelihood = 0.0;
  std::ranges::fill(size, 0.0);
  std::ranges::fill(covariance, 0.0);
  std::ranges::fill(lone, kUnknown);
  std::ranges::fill(effect, Effect{});
}

void ChangeMonitor::expect_usual_errors(Start& start) const {
  for (std::size_t a = 0; a < axes(); ++a) {
    start.scatter[a] = scatter_[a].value();
    start.tau[a] = correlation_[a].rows_per_sample();
  }
}

// A start with half of the evidence lives on, since the peak may be of a change.
void ChangeMonitor::end_old_starts(double t) {
  for (Start& start : starts_) {
    if (!start.alive || t - start.begun_s <= start.life_s) {
      continue;
    }
    if (start.evidence > 0.5 * threshold() && start.life_s < kChange.longest_life_s) {
      start.life_s *= 2.0;
    } else {
      start.alive = false;
      usual_ *= std::exp(-kChange.start_every_s / kChange.usual_memory_s);
      usual_ = std::max(start.peak, usual_);
    }
  }
}

// θᵀφ of an axis, and the change of this value per unit of each size.
void ChangeMonitor::effects(std::span<const double> theta, std::size_t axis) {
  std::ranges::fill(effect_, 0.0);
  std::ranges::fill(square_, 0.0);
  value_ = theta.back();
  for (std::size_t k = 0; k + 1 < columns(); ++k) {
    const double part = theta[k] * phi_[k];
    value_ += part;
    for (const Factor& factor : term_commands_[k]) {
      effect_[factor.command] += part;
      square_[factor.command] += factor.power > 1.0 ? part : 0.0;
    }
    if (term_drag_[k] == axis) {
      effect_[commands_ + axis] += part;
    }
  }
  effect_[commands_ + axes() + axis] = value_;
}

// The change of an axis' value per unit of a lone size.
double ChangeMonitor::lone_effect(std::size_t lone, std::size_t axis) const {
  return lone < causes() ? effect_[lone] : effect_[commands_ + (lone - causes()) * axes() + axis];
}

// As observe() with one size alone; `error`: of the vehicle before, `unchanged`: the log density of
// no change. A size that explains less than no change begins anew (CUSUM: Page 1954), and so at the
// change.
void ChangeMonitor::observe_lone(Start& start, std::size_t axis, double error, double noise,
                                 double unchanged) {
  for (std::size_t k = 0; k < start.lone.size(); ++k) {
    Lone& lone = start.lone[k];
    const double effect = lone_effect(k, axis);
    const double left = error - effect * lone.size;
    const double variance = noise + effect * effect * lone.variance;
    lone.likelihood += (robust_log_density(left, variance) - unchanged) / start.tau[axis];
    const double weight = robust_weight(left, variance) / start.tau[axis];
    const double gain = lone.variance * effect / (noise / weight + effect * effect * lone.variance);
    lone.size += gain * left;
    lone.variance *= 1.0 - gain * effect;
    if (lone.likelihood <= 0.0) {
      lone = kUnknown;
    }
  }
}

// The evidence of one row, then a Kalman update of the sizes. The start is compared with the fit,
// or with the vehicle before the change.
void ChangeMonitor::observe(Start& start, std::span<const double> y, bool against_fit) {
  auto covariance = columns_of(std::span<double>(start.covariance), causes());
  auto size = as_vector(start.size);
  auto gain = as_vector(gain_);
  const auto effect = as_vector(std::span<const double>(effect_));
  for (std::size_t a = 0; a < axes(); ++a) {
    effects(std::span(start.theta).subspan(a * columns(), columns()), a);
    const double noise = start.scatter[a] * start.scatter[a] * (1.0 + leverage_);
    gain.noalias() = covariance * effect;
    const double unknown = effect.dot(gain);
    const double without = against_fit ? error_[a] : y[a] - value_;
    const double error = y[a] - value_ - effect.dot(size);
    const double unchanged = robust_log_density(without, noise);
    observe_lone(start, a, y[a] - value_, noise, unchanged);
    for (std::size_t c = 0; c < commands_; ++c) {
      start.effect[c].add(effect_[c] - square_[c], square_[c], 1.0 / noise);
    }
    start.likelihood += (robust_log_density(error, noise + unknown) - unchanged) / start.tau[a];
    const double gained = log_density(error, noise + unknown) - log_density(without, noise);
    start.evidence += std::clamp(gained, -kChange.clip_nats, kChange.clip_nats) / start.tau[a];
    start.samples += 1.0 / start.tau[a];
    const double weight = robust_weight(error, noise + unknown) / start.tau[a];
    const double scale = 1.0 / (noise / weight + unknown);
    size += (scale * error) * gain;
    for (Eigen::Index c = 0; c < gain.size(); ++c) {
      covariance.col(c) -= (scale * gain(c)) * gain;
    }
  }
  start.peak = std::max(start.peak, start.evidence);
}

const ChangeMonitor::Start* ChangeMonitor::most_evident() const {
  const Start* best = nullptr;
  for (const Start& start : starts_) {
    if (start.alive && (best == nullptr || start.evidence > best->evidence)) {
      best = &start;
    }
  }
  return best;
}

// An older start saw rows of before the change, which hold its sizes back. The evidence of a row is
// bounded, and hardly tells such starts from those at the change.
ChangeMonitor::Start& ChangeMonitor::youngest_with(double evidence) {
  Start* youngest = nullptr;
  for (Start& start : starts_) {
    if (start.alive && start.evidence >= evidence &&
        (youngest == nullptr || start.begun_s > youngest->begun_s)) {
      youngest = &start;
    }
  }
  return *youngest;
}

ChangeMonitor::Event ChangeMonitor::believe(Start& start, double t) {
  changed_start_ = static_cast<std::size_t>(&start - starts_.data());
  believed_s_ = t;
  moved_s_ = t;
  since_s_ = start.begun_s;
  std::ranges::fill(told_, 0.0);
  std::ranges::fill(told_gains_, 1.0);
  gained_ = clear_command(start).value_or(commands_);
  move_to(&start);
  return Event::changed;
}

// The last start before a time, whose coefficients no later row has touched; else a new one.
ChangeMonitor::Start& ChangeMonitor::start_before(double since_s) {
  Start* last = nullptr;
  for (Start& start : starts_) {
    if (start.alive && start.begun_s <= since_s &&
        (last == nullptr || start.begun_s > last->begun_s)) {
      last = &start;
    }
  }
  if (last == nullptr) {
    last = &starts_.front();
    std::ranges::copy(fit_.theta(), last->theta.begin());
  }
  return *last;
}

// Drag is not followed: where the speed hardly varies, it is as the thrust and the constant force.
std::optional<std::size_t> ChangeMonitor::command_of(const Cause& cause) const {
  const auto found = std::ranges::find(gains_, cause.place, &CommandGain::input);
  const auto command = static_cast<std::size_t>(found - gains_.begin());
  const bool follows =
      cause.kind == CauseKind::thruster && found != gains_.end() && scales_[command];
  return follows ? std::optional(command) : std::nullopt;
}

ChangeMonitor::Event ChangeMonitor::believe_cause(const Cause& cause, double since_s) {
  const std::optional<std::size_t> command = command_of(cause);
  if (!command || changed_start_ < kMostStarts || !errors_known() || since_s <= believed_s_) {
    return Event::none;
  }
  const double size = cause.size - 1.0;
  const double variance = kChange.named_deviation * kChange.named_deviation;
  Start& start = start_before(since_s);
  start.begin(since_s, kChange.life_s);
  expect_usual_errors(start);
  start.size[*command] = size;
  start.covariance[*command * (causes() + 1)] = variance;
  start.lone[*command] = {.size = size, .variance = variance, .likelihood = kChange.enough};
  start.effect = usual_effect_;
  return believe(start, row_s_);
}

// One cause that explains nearly all that all causes together explain: errors of the equation of
// motion favour many small changes, and a thruster that fails is more usual.
std::optional<std::size_t> ChangeMonitor::clear_command(const Start& start) const {
  const auto lone = std::ranges::max_element(start.lone, {}, &Lone::likelihood);
  const auto command = static_cast<std::size_t>(lone - start.lone.begin());
  const bool clear = command < commands_ && scales_[command] &&
                     lone->likelihood >= kChange.lone_share * start.likelihood;
  return clear ? std::optional(command) : std::nullopt;
}

void ChangeMonitor::Effect::add(double linear, double square, double weight) {
  ll += weight * linear * linear;
  lq += weight * linear * square;
  qq += weight * square * square;
}

double ChangeMonitor::Effect::gain(double size) const {
  double best = 1.0;
  double least = std::numeric_limits<double>::infinity();
  for (double g = kChange.least_gain; g <= kChange.most_gain; g += kChange.gain_step) {
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

// gains_ leads from the commands' factors in service to those of the start; null: of before the
// change.
void ChangeMonitor::move_gains(const Start* start) {
  if (start != nullptr) {
    gained_ = clear_command(*start).value_or(gained_);
  }
  for (std::size_t c = 0; c < commands_; ++c) {
    const bool has_failed = start != nullptr && c == gained_;
    const double gain = has_failed ? start->effect[c].gain(start->lone[c].size) : 1.0;
    gains_[c].factor = gain / told_gains_[c];
    told_gains_[c] = gain;
  }
}

// The sizes of all hypotheses of a start, weighted by their likelihood.
void ChangeMonitor::mix_sizes(const Start& start) {
  const double most = std::max(
      start.likelihood, std::ranges::max_element(start.lone, {}, &Lone::likelihood)->likelihood);
  double sum = std::exp(start.likelihood - most);
  as_vector(mixed_) = sum * as_vector(std::span<const double>(start.size));
  for (std::size_t k = 0; k < start.lone.size(); ++k) {
    const double weight = std::exp(start.lone[k].likelihood - most);
    const bool one = k < causes();
    const std::size_t first = one ? k : commands_ + (k - causes()) * axes();
    for (std::size_t c = first; c < first + (one ? 1 : axes()); ++c) {
      mixed_[c] += weight * start.lone[k].size;
    }
    sum += weight;
  }
  as_vector(mixed_) /= sum;
}

// step_ leads from the coefficients in service to those of the start; null: of before the change.
void ChangeMonitor::move_to(const Start* start) {
  if (by_gain()) {
    move_gains(start);
    return;
  }
  if (start != nullptr) {
    mix_sizes(*start);
  }
  for (std::size_t a = 0; a < axes(); ++a) {
    for (std::size_t k = 0; k < columns(); ++k) {
      double share = 0.0;
      if (start != nullptr) {
        share = mixed_[commands_ + axes() + a];
        if (k + 1 < columns()) {
          for (const Factor& factor : term_commands_[k]) {
            share += mixed_[factor.command];
          }
          share += term_drag_[k] == a ? mixed_[commands_ + a] : 0.0;
        }
      }
      const std::size_t place = a * columns() + k;
      const double change = start != nullptr ? share * start->theta[place] : 0.0;
      step_[place] = change - told_[place];
      told_[place] = change;
    }
  }
}

ChangeMonitor::Event ChangeMonitor::follow(std::span<const double> y, double t) {
  Start& start = starts_[changed_start_];
  if (std::isfinite(leverage_)) {
    observe(start, y, false);
  }
  if (start.evidence < start.peak - kChange.enough) {
    move_to(nullptr);
    usual_ = std::max(usual_, start.peak);
    changed_start_ = kMostStarts;
    std::ranges::for_each(starts_, [](Start& one) { one.alive = false; });
    return Event::withdrawn;
  }
  if (t - believed_s_ > kChange.probation_s) {
    return settle();
  }
  if (t - believed_s_ <= kChange.settle_s && t - moved_s_ >= kChange.move_every_s) {
    moved_s_ = t;
    move_to(&start);
    return Event::refined;
  }
  return Event::none;
}

// The changed vehicle becomes the vehicle without a change.
ChangeMonitor::Event ChangeMonitor::settle() {
  const Start& start = starts_[changed_start_];
  if (by_gain()) {
    fit_.set_theta(start.theta);
    as_vector(phi_).setOnes();
    for (std::size_t k = 0; k + 1 < columns(); ++k) {
      for (const Factor& factor : term_commands_[k]) {
        phi_[k] *= std::pow(told_gains_[factor.command], -factor.power);
      }
    }
    fit_.rescale(phi_, 1.0);
  } else {
    std::ranges::transform(start.theta, told_, step_.begin(), std::plus<>{});
    fit_.set_theta(step_);
  }
  if (samples_ > kKept) {
    fit_.limit_rows(std::llround(static_cast<double>(fit_.rows()) * kKept / samples_));
    samples_ = kKept;
  }
  changed_start_ = kMostStarts;
  std::ranges::for_each(starts_, [](Start& one) { one.alive = false; });
  return Event::none;
}

void ChangeMonitor::restart() {
  fit_.clear();
  std::ranges::for_each(scatter_, &RobustScale::clear);
  std::ranges::for_each(starts_, [](Start& one) { one.alive = false; });
  changed_start_ = kMostStarts;
  believed_s_ = row_s_;
  samples_ = 0.0;
}

void ChangeMonitor::Effect::visit(Archive& archive) {
  for (double* const number : {&ll, &lq, &qq}) {
    archive.number(*number);
  }
}

void ChangeMonitor::Start::visit(Archive& archive) {
  archive.flag(alive);
  if (!alive) {
    return;
  }
  for (double* const number : {&begun_s, &life_s, &evidence, &samples, &peak, &likelihood}) {
    archive.number(*number);
  }
  for (std::vector<double>* const values : {&theta, &size, &covariance, &scatter, &tau}) {
    archive.numbers(*values);
  }
  std::ranges::for_each(effect, [&](Effect& one) { one.visit(archive); });
  for (Lone& one : lone) {
    for (double* const number : {&one.size, &one.variance, &one.likelihood}) {
      archive.number(*number);
    }
  }
}

void ChangeMonitor::visit(Archive& archive) {
  archive.part("fit", fit_);
  for (std::size_t a = 0; a < axes(); ++a) {
    archive.part("scatter", scatter_[a]);
    archive.part("correlation", correlation_[a]);
  }
  std::ranges::for_each(starts_, [&](Start& start) { archive.part("start", start); });
  archive.whole(changed_start_, 0, kMostStarts);
  archive.require(changed_start_ == kMostStarts || starts_[changed_start_].alive,
                  "holds a change without a start");
  archive.any_number(believed_s_);
  for (double* const number : {&moved_s_, &since_s_, &samples_, &usual_}) {
    archive.number(*number);
  }
  archive.any_number(row_s_);
  archive.any_number(begun_s_);
  archive.whole(rows_);
  archive.whole(begun_);
  archive.numbers(told_);
  archive.numbers(told_gains_);
  std::ranges::for_each(usual_effect_, [&](Effect& one) { one.visit(archive); });
  archive.whole(gained_, 0, commands_);
}

}  // namespace kelpie
