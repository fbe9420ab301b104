// SPDX-License-Identifier: Apache-2.0
#include "model/change_monitor.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>

#include "core/eigen.hpp"
#include "model/tuning.hpp"

namespace kelpie {
namespace {

constexpr const auto& kChange = kModelTuning.change;
constexpr double kKept = kChange.kept;
constexpr double kBefore = -std::numeric_limits<double>::infinity();  // of all times [s]

// Of a thruster's effect, or of drag, within the errors of a factor.
bool is_possible_factor(double factor) {
  return factor >= -kChange.named_deviation && factor <= kChange.most_gain;
}

std::size_t used_terms(const TermSet& terms) {
  return terms.size() <= kChange.most_terms ? terms.size()
                                            : std::min(terms.without_products(), terms.size());
}

}  // namespace

ChangeMonitor::ChangeMonitor(const TermSet& terms, std::span<const std::size_t> states,
                             std::span<const std::size_t> commands)
    : terms_(terms),
      commands_(commands.size()),
      term_commands_(used_terms(terms)),
      term_drag_(used_terms(terms), states.size()),
      fit_(used_terms(terms) + 1, kChange.prior, states.size()),
      scatter_(states.size()),
      correlation_(states.size()),
      starts_(kMostStarts, ChangeStart(commands_, states.size(), columns() * states.size())),
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
      effect_(axes()),
      usual_error_(axes()),
      effects_{.of_cause = std::vector<double>(causes() + kCausesOfMany),
               .square = std::vector<double>(commands.size())},
      mixed_(causes()),
      usual_effect_(commands.size()) {
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
        term_commands_[k].push_back({c, terms.power(k, commands[c]) > 1.0});
      }
    }
    if (inputs.size() == 1) {
      term_drag_[k] =
          static_cast<std::size_t>(std::ranges::find(states, inputs[0]) - states.begin());
    }
  }
  told_gains_ = gains_;
}

ChangeMonitor::Event ChangeMonitor::update(std::span<const double> x, std::span<const double> y,
                                           double t) {
  if (t - row_s_ < kModelTuning.almost * kChange.step_s) {
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
    for (ChangeStart& start : starts_) {
      if (start.alive) {
        observe(start, y, true);
      }
    }
  }
  const ChangeStart* const likely = most_evident();
  if (likely != nullptr && likely->evidence > threshold()) {
    ChangeStart& start = youngest_with(kChange.alike * likely->evidence);
    if (is_clear(start)) {
      named_ = false;
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
    find_effects(fit_.theta(a), a);
    error_[a] = y[a] - effects_.value;
    const std::span<const double> effects(effects_.of_cause);
    effect_[a] = std::hypot(as_vector(effects.first(commands_)).norm(), effects[all_drag()]);
    usual_error_[a] = scatter_[a].value() * scatter_[a].ratio(effect_[a]);
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
    const double usual = usual_error_[a];
    if (std::isfinite(usual) && std::isfinite(leverage_)) {
      weight = std::min(weight, robust_weight(error_[a], usual * usual * (1.0 + leverage_)));
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
    if (known()) {
      scatter_[a].add_with(error, effect_[a]);
    }
    if (std::isfinite(usual_error_[a]) && usual_error_[a] > 0.0) {
      correlation_[a].add(
          std::clamp(error / usual_error_[a], -kChange.clip_errors, kChange.clip_errors));
    }
  }
  for (std::size_t a = 0; errors_known() && a < axes(); ++a) {
    find_effects(fit_.theta(a), a);
    for (std::size_t c = 0; c < commands_; ++c) {
      usual_effect_[c].add(effects_, c, weight / (usual_error_[a] * usual_error_[a]));
    }
  }
  const double root = std::sqrt(weight);
  as_vector(phi_) *= root;
  std::ranges::transform(y, weighted_y_.begin(), [root](double value) { return root * value; });
  fit_.add(phi_, weighted_y_);
}

bool ChangeMonitor::errors_known() const {
  return std::ranges::all_of(scatter_, [](const ErrorsByEffect& scatter) {
    return std::isfinite(scatter.value()) && scatter.value() > 0.0;
  });
}

// Every second start lives twice as long as the others, every fourth four times, and so on: starts
// of all ages up to ten minutes, the young ones close together. A start with the coefficients of a
// vehicle that is not known yet would take what is learned of the vehicle for a change.
void ChangeMonitor::begin_start(double t) {
  const auto free = std::ranges::find(starts_, false, &ChangeStart::alive);
  if (t - begun_s_ < kChange.start_every_s || free == starts_.end() || !known() ||
      !errors_known()) {
    return;
  }
  begun_s_ = t;
  ++begun_;
  const int doublings = std::min(std::countr_zero(begun_), kChange.doublings);
  expect_usual_errors(*free);
  free->begin(t, kChange.life_s * static_cast<double>(1 << doublings));
  std::ranges::copy(fit_.theta(), free->theta.begin());
  free->expect_all_causes();
}

void ChangeMonitor::expect_usual_errors(ChangeStart& start) const {
  for (std::size_t a = 0; a < axes(); ++a) {
    start.scatter[a] = scatter_[a].value();
    start.tau[a] = correlation_[a].rows_per_sample();
  }
}

// A start with half of the evidence lives on, since the peak may be of a change.
void ChangeMonitor::end_old_starts(double t) {
  for (ChangeStart& start : starts_) {
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

void ChangeMonitor::find_effects(std::span<const double> theta, std::size_t axis) {
  std::vector<double>& effect = effects_.of_cause;
  std::ranges::fill(effect, 0.0);
  std::ranges::fill(effects_.square, 0.0);
  double& value = effects_.value;
  value = theta.back();
  double drag = 0.0;
  double commanded = 0.0;
  for (std::size_t k = 0; k + 1 < columns(); ++k) {
    const double part = theta[k] * phi_[k];
    value += part;
    for (const Factor& factor : term_commands_[k]) {
      effect[factor.command] += part;
      effects_.square[factor.command] += factor.higher ? part : 0.0;
    }
    drag += term_drag_[k] == axis ? part : 0.0;
    commanded += term_commands_[k].empty() ? 0.0 : part;
  }
  effect[commands_ + axis] = effect[all_drag()] = drag;
  effect[commands_ + axes() + axis] = effect[all_inertia()] = value;
  effect[all_commands()] = commanded;
}

// The start is compared with the fit, or with the vehicle before the change.
void ChangeMonitor::observe(ChangeStart& start, std::span<const double> y, bool against_fit) {
  for (std::size_t a = 0; a < axes(); ++a) {
    find_effects(std::span(start.theta).subspan(a * columns(), columns()), a);
    const double without = against_fit ? error_[a] : y[a] - effects_.value;
    const double ratio = usual_error_[a] / scatter_[a].value();
    start.observe(a, effects_, y[a], without, ratio * ratio * (1.0 + leverage_));
  }
  start.peak = std::max(start.peak, start.evidence);
}

// Slow drifts, which a model follows anyway, gain less of a sample; what constant errors do not
// explain at all is no drift.
bool ChangeMonitor::is_clear(const ChangeStart& start) const {
  const double per_sample = start.evidence / start.samples;
  return (start.over_constant > kChange.over_constant && per_sample > kChange.clear) ||
         (start.over_constant > kChange.enough && per_sample > kChange.likely &&
          has_likely_cause(start));
}

const ChangeStart* ChangeMonitor::most_evident() const {
  const ChangeStart* best = nullptr;
  for (const ChangeStart& start : starts_) {
    if (start.alive && (best == nullptr || start.evidence > best->evidence)) {
      best = &start;
    }
  }
  return best;
}

// An older start saw rows of before the change, which hold its sizes back. The evidence of a row is
// bounded, and hardly tells such starts from those at the change.
ChangeStart& ChangeMonitor::youngest_with(double evidence) {
  ChangeStart* youngest = nullptr;
  for (ChangeStart& start : starts_) {
    if (start.alive && start.evidence >= evidence &&
        (youngest == nullptr || start.begun_s > youngest->begun_s)) {
      youngest = &start;
    }
  }
  return *youngest;
}

ChangeMonitor::Event ChangeMonitor::believe(ChangeStart& start, double t) {
  changed_start_ = static_cast<std::size_t>(&start - starts_.data());
  believed_s_ = t;
  moved_s_ = t;
  since_s_ = start.begun_s;
  std::ranges::fill(told_, 0.0);
  for (CommandGain& told : told_gains_) {
    told.factor = 1.0;
  }
  gained_ = clear_command(start).value_or(commands_);
  move_to(&start);
  return Event::changed;
}

// The last start before a time, whose coefficients no later row has touched; else a new one.
ChangeStart& ChangeMonitor::start_before(double since_s) {
  ChangeStart* last = nullptr;
  for (ChangeStart& start : starts_) {
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
  const bool follows = cause.kind == CauseKind::thruster && is_possible_factor(cause.size) &&
                       found != gains_.end() && scales_[command];
  return follows ? std::optional(command) : std::nullopt;
}

ChangeMonitor::Event ChangeMonitor::believe_cause(const Cause& cause, double since_s) {
  const std::optional<std::size_t> command = command_of(cause);
  if (!command || changed_start_ < kMostStarts || !errors_known() || since_s <= believed_s_) {
    return Event::none;
  }
  ChangeStart& start = start_before(since_s);
  expect_usual_errors(start);
  start.begin(since_s, kChange.life_s);
  start.expect_cause(*command, cause.size - 1.0, kChange.named_deviation * kChange.named_deviation);
  start.effect = usual_effect_;
  named_ = true;
  return believe(start, row_s_);
}

ChangeMonitor::Event ChangeMonitor::disbelieve_cause() {
  return named_command() ? withdraw() : Event::none;
}

// One cause that explains nearly all that all causes together explain: errors of the equation of
// motion favour many small changes, and a thruster that fails is more usual.
std::optional<std::size_t> ChangeMonitor::clear_command(const ChangeStart& start) const {
  const auto others = std::span(start.lone).first(all_commands());  // while idle, all are as one
  const auto lone = std::ranges::max_element(others, {}, &LoneCause::likelihood);
  const auto command = static_cast<std::size_t>(lone - others.begin());
  const bool clear = command < commands_ && scales_[command] &&
                     lone->likelihood >= kChange.lone_share * start.likelihood;
  return clear ? std::optional(command) : std::nullopt;
}

// One cause that explains most of what all causes together explain, and that a vehicle may have.
// Not inertia, which scales all effects: so does a calm minute with other errors than a manoeuvre.
bool ChangeMonitor::has_likely_cause(const ChangeStart& start) const {
  const auto lone = std::ranges::max_element(start.lone, {}, &LoneCause::likelihood);
  const auto cause = static_cast<std::size_t>(lone - start.lone.begin());
  const bool is_inertia =
      (cause >= commands_ + axes() && cause < causes()) || cause == all_inertia();
  return !is_inertia && is_possible_factor(1.0 + lone->size) &&
         lone->likelihood >= kChange.main_share * start.likelihood;
}

// gains_ leads from the commands' factors in service to those of the start; null: of before the
// change.
void ChangeMonitor::move_gains(const ChangeStart* start) {
  if (start != nullptr) {
    gained_ = clear_command(*start).value_or(gained_);
  }
  for (std::size_t c = 0; c < commands_; ++c) {
    const bool has_failed = start != nullptr && c == gained_;
    const double gain = has_failed ? start->effect[c].gain(start->lone[c].size) : 1.0;
    gains_[c].factor = gain / told_gains_[c].factor;
    told_gains_[c].factor = gain;
  }
}

// step_ leads from the coefficients in service to those of the start; null: of before the change.
void ChangeMonitor::move_to(const ChangeStart* start) {
  if (by_gain()) {
    move_gains(start);
    return;
  }
  if (start != nullptr) {
    start->mix_sizes(mixed_);
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
  ChangeStart& start = starts_[changed_start_];
  if (std::isfinite(leverage_)) {
    observe(start, y, false);
  }
  if (start.evidence < start.peak - kChange.enough) {
    usual_ = std::max(usual_, start.peak);
    return withdraw();
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

ChangeMonitor::Event ChangeMonitor::withdraw() {
  move_to(nullptr);
  end_all_starts();
  return Event::withdrawn;
}

// The changed vehicle becomes the vehicle without a change.
ChangeMonitor::Event ChangeMonitor::settle() {
  const ChangeStart& start = starts_[changed_start_];
  if (by_gain()) {
    fit_.set_theta(start.theta);
    for (std::size_t k = 0; k + 1 < columns(); ++k) {
      phi_[k] = 1.0 / term_gain(terms_, k, told_gains_);
    }
    phi_.back() = 1.0;
    fit_.rescale(phi_);
  } else {
    std::ranges::transform(start.theta, told_, step_.begin(), std::plus<>{});
    fit_.set_theta(step_);
  }
  if (samples_ > kKept) {
    fit_.limit_rows(std::llround(static_cast<double>(fit_.rows()) * kKept / samples_));
    samples_ = kKept;
  }
  end_all_starts();
  return Event::none;
}

void ChangeMonitor::end_all_starts() {
  changed_start_ = kMostStarts;
  std::ranges::for_each(starts_, [](ChangeStart& one) { one.alive = false; });
}

void ChangeMonitor::restart() {
  fit_.clear();
  std::ranges::for_each(scatter_, &ErrorsByEffect::clear);
  std::ranges::fill(usual_effect_, CommandEffect{});
  end_all_starts();
  believed_s_ = row_s_;
  samples_ = 0.0;
}

void ChangeMonitor::begin_again() {
  restart();
  std::ranges::fill(correlation_, ErrorCorrelation());
  usual_ = 0.0;
}

void ChangeMonitor::visit(Archive& archive) {
  archive.part("fit", fit_);
  for (std::size_t a = 0; a < axes(); ++a) {
    archive.part("scatter", scatter_[a]);
    archive.part("correlation", correlation_[a]);
  }
  std::ranges::for_each(starts_, [&](ChangeStart& start) { archive.part("start", start); });
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
  std::ranges::for_each(told_gains_, [&](CommandGain& told) { archive.number(told.factor); });
  std::ranges::for_each(usual_effect_, [&](CommandEffect& one) { one.visit(archive); });
  archive.whole(gained_, 0, commands_);
  archive.flag(named_);
}

}  // namespace kelpie
