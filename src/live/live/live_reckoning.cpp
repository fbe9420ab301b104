// SPDX-License-Identifier: Apache-2.0
#include "live/live_reckoning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string_view>
#include <utility>

#include "core/angle.hpp"
#include "core/seconds.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/model/trained_model.hpp"
#include "live/tuning.hpp"
#include "motion/states.hpp"
#include "navigation/named_settings.hpp"

namespace kelpie::live {
namespace {

constexpr std::size_t kMostStates = 6;  // of a DeadReckoning
constexpr std::size_t kYawRate = 2;     // in the plane
constexpr std::string_view kNoPose = "no pose is measured";
constexpr std::string_view kLost = "an input is silent and no velocity is measured";

std::vector<std::size_t> late_inputs_of(const StreamPlan& plan) {
  std::vector<std::size_t> late;
  const auto& names = StreamPlan::Pose::kVelocities;
  for (std::size_t i = 0; plan.pose && i < plan.inputs.size(); ++i) {
    const std::string& input = plan.inputs[i];
    if (std::ranges::count(names, input) > 0 &&
        std::ranges::count(plan.sources, input, &StreamPlan::Source::name) == 0) {
      late.push_back(i);
    }
  }
  return late;
}

// The error of a model that doesn't know its commands: as much as those change an acceleration
// within the range that was seen. Rudders act at speed.
OpenLoop without_commands(OpenLoop loop) {
  std::vector<double> x;
  for (std::size_t i = 0; i < loop.seen.size(); ++i) {
    const auto& [low, high] = loop.seen[i];
    const bool is_state = std::ranges::find(loop.states, i) != loop.states.end();
    x.push_back(is_state ? high : std::midpoint(low, high));
  }
  std::vector<double> least(loop.states.size());
  std::vector<double> most(loop.states.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::ranges::find(loop.states, i) != loop.states.end()) {
      continue;
    }
    const double usual = x[i];
    x[i] = loop.seen[i].low;
    loop.accelerations(x, least);
    x[i] = loop.seen[i].high;
    loop.accelerations(x, most);
    x[i] = usual;
    for (std::size_t k = 0; k < most.size(); ++k) {
      loop.error[k] = std::hypot(loop.error[k], (most[k] - least[k]) / 2.0);
    }
  }
  return loop;
}

std::string_view fault_text(VelocityFault fault) {
  switch (fault) {
    case VelocityFault::zero:
      return "the velocity log gives exact zeros";
    case VelocityFault::frozen:
      return "the velocity log gives one value, to the last bit";
    case VelocityFault::implausible:
      return "the velocity log contradicts the estimate";
    default:
      return "the velocity log measures nothing";
  }
}

}  // namespace

std::shared_ptr<const ReckoningModel> reckoning_model(const DynamicsModel& model,
                                                      std::shared_ptr<const Alignment> alignment) {
  if (!model.ready()) {
    return nullptr;
  }
  try {
    return std::make_shared<const ReckoningModel>(
        ReckoningModel{.loop = open_loop(model.trained(), OpenLoopPart::steady),
                       .alignment = std::move(alignment)});
  } catch (const InputError&) {
    return nullptr;  // too few samples for the equations
  }
}

LiveReckoning::LiveReckoning(const Configuration& configuration)
    : configuration_(configuration),
      states_(find_states(configuration.settings.shared.states, configuration.plan.inputs,
                          configuration.plan.targets.size())),
      commands_(configuration.plan.inputs, configuration.plan.rate_hz, configuration.plan.gap_s),
      heading_(configuration),
      late_(late_inputs_of(configuration.plan)),
      present_commands_(commands_),
      x_(configuration.plan.inputs.size()) {
  if (states_.size() > kMostStates) {
    states_.clear();
  }
  for (const std::size_t state : states_) {
    names_.push_back(configuration.plan.inputs[state]);
    health_.velocities.push_back({.name = names_.back()});
  }
  heard_.resize(states_.size());
}

bool LiveReckoning::wants_model(double t) {
  const double apart_s = model_ ? kTuning.between_models_s : kTuning.between_first_models_s;
  if (states_.empty() || waits_ || std::abs(t - asked_s_) < apart_s) {
    return false;
  }
  waits_ = true;
  asked_s_ = t;
  due_s_ = t + kTuning.model_delay_s;
  due_s_ += late_.empty() ? 0.0 : usual_silence_s();
  return true;
}

void LiveReckoning::use(std::shared_ptr<const ReckoningModel> model) {
  waits_ = false;
  if (!model) {
    return;
  }
  model_ = std::move(model);
  if (reckoning_) {
    reckoning_->use(holds_ ? without_commands(model_->loop) : model_->loop);
  } else {
    settings_ = named_settings(model_->loop);
    settings_.between = path();
    reckoning_ = std::make_unique<DeadReckoning>(model_->loop, settings_);
  }
}

// A command holds until the next one; what an actuator makes of commands, and what is measured,
// changes in between.
CommandPath LiveReckoning::path() const {
  const StreamPlan& plan = configuration_.plan;
  for (std::size_t i = 0; i < plan.inputs.size(); ++i) {
    const bool is_velocity = std::ranges::find(states_, i) != states_.end();
    const auto source = std::ranges::find(plan.sources, plan.inputs[i], &StreamPlan::Source::name);
    if (!is_velocity && source != plan.sources.end() && source->between == Interpolation::line) {
      return CommandPath::linear;
    }
  }
  return model_->alignment->actuators.empty() ? CommandPath::held : CommandPath::linear;
}

// Other actuators give commands in other units: the model goes on from those of this sample.
void LiveReckoning::take_sample(double t, const Receiver& receiver, Output& output) {
  if (aligned_ != model_->alignment) {
    aligned_ = model_->alignment;
    settings_.between = path();
    reckoning_->restate(x_, settings_.between);
  }
  reckoning_->update(x_, t);
  if (!settings_.planar || !reckoning_->started()) {
    return;
  }
  if (const auto heading = heading_.next(receiver, t, reckoning_->velocity(kYawRate), output)) {
    reckoning_->measured_heading(*heading, kTuning.heading_deviation_rad);
  }
}

void LiveReckoning::begin_anew(const Receiver& receiver) {
  restarts_ = receiver.stream().restarts();
  *reckoning_ = DeadReckoning(model_->loop, settings_);
  present_.reset();
  heading_.begin_anew();
  based_s_ = -std::numeric_limits<double>::infinity();
  t_ = -std::numeric_limits<double>::infinity();
  asked_s_ = t_;
  believed_s_ = t_;
  waits_ = false;
  holds_ = false;
  is_lost_ = false;
}

bool LiveReckoning::take_velocities(const Receiver& receiver) {
  bool is_new = false;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const SignalHistory* const signal = receiver.input_signal(states_[i]);
    const std::size_t samples = signal == nullptr ? 0 : signal->faults().samples;
    if (samples > heard_[i] && signal->size() > 0) {
      x_[states_[i]] = signal->value(signal->size() - 1);
      is_new = true;
    }
    heard_[i] = samples;
  }
  return is_new;
}

std::optional<ReckonedSample> LiveReckoning::update(const Receiver& receiver,
                                                    std::int64_t received_ns, Output& output) {
  if (!reckoning_ || !receiver.origin_ns()) {
    return std::nullopt;
  }
  if (receiver.stream().restarts() != restarts_) {
    begin_anew(receiver);
  }
  if (!late_.empty()) {
    return update_present(receiver, received_ns, output);
  }
  commands_.use(model_->alignment);
  const std::span<const double> shifts_s = commands_.shifts_s();
  const bool has_commands = receiver.inputs_at(receiver.now_s(), shifts_s, x_, states_);
  const bool is_known =
      has_commands || receiver.held_inputs_at(receiver.now_s(), shifts_s, x_, states_);
  const bool is_new = take_velocities(receiver);
  const double now_s = std::max(receiver.now_s(), t_);
  if (!is_known || (!is_new && now_s < t_ + kTuning.least_step_s)) {
    return std::nullopt;
  }
  commands_.act(x_, now_s);
  t_ = now_s;
  follow_commands(has_commands);
  take_sample(t_, receiver, output);
  if (!reckoning_->started()) {
    return std::nullopt;
  }
  if (is_new && has_commands) {
    note_faults();
  }
  return sample(receiver, received_ns, output);
}

std::optional<ReckonedSample> LiveReckoning::sample(const Receiver& receiver,
                                                    std::int64_t received_ns, Output& output) {
  note_loss(output);
  note_outage(output);
  if (is_lost_) {
    return std::nullopt;
  }
  return ReckonedSample{.stamp_ns = received_ns,
                        .data_ns = *receiver.origin_ns() + nanoseconds(t_),
                        .names = names_,
                        .reckoning = *present()};
}

// From a row of poses until there is the next one: half a window, and what the stream waits.
double LiveReckoning::usual_silence_s() const {
  const StreamPlan& plan = configuration_.plan;
  return late_.empty() ? 0.0 : plan.pose->half_s + plan.gap_s + plan.wait_s;
}

// After a long silence it begins anew: what was practised meanwhile is of the other model.
void LiveReckoning::follow_commands(bool has_commands) {
  if (holds_ == !has_commands) {
    return;
  }
  holds_ = !has_commands;
  if (holds_) {
    held_from_s_ = t_;
  } else if (t_ > held_from_s_ + kTuning.longest_hold_s) {
    *reckoning_ = DeadReckoning(model_->loop, settings_);
    present_.reset();
    heading_.begin_anew();
    based_s_ = -std::numeric_limits<double>::infinity();
    return;
  }
  const OpenLoop loop = holds_ ? without_commands(model_->loop) : model_->loop;
  reckoning_->use(loop);
  if (present_) {
    present_->use(loop);
  }
}

void LiveReckoning::take_row(const SampleRow& row, const Receiver& receiver, Output& output) {
  if (late_.empty() || !reckoning_) {
    return;
  }
  commands_.use(model_->alignment);
  if (!receiver.held_inputs_at(row.t, commands_.shifts_s(), x_, late_)) {
    return;
  }
  const bool is_stuck = configuration_.live.frozen == Frozen::skip && receiver.is_stuck(row.t);
  for (const std::size_t input : late_) {
    x_[input] = is_stuck ? std::numeric_limits<double>::quiet_NaN() : row.x[input];
  }
  commands_.act(x_, row.t);
  take_sample(row.t, receiver, output);
  row_x_.assign(row.x.begin(), row.x.end());
  if (!reckoning_->started() || row.t < based_s_ + kTuning.between_poses_s) {
    return;
  }
  health_.largest_step = std::max(health_.largest_step, reckoning_->step());
  based_s_ = row.t;
  present_ = std::make_unique<DeadReckoning>(*reckoning_);
  present_commands_ = commands_;
  const double step_s = std::max(kTuning.between_poses_s, 1.0 / configuration_.plan.rate_hz);
  for (double t = row.t + step_s; t < receiver.now_s(); t += step_s) {
    advance(receiver, t);
  }
}

// By the model and the commands alone.
void LiveReckoning::advance(const Receiver& receiver, double t) {
  if (receiver.held_inputs_at(t, present_commands_.shifts_s(), x_, late_)) {
    present_commands_.act(x_, t);
    present_->update(x_, t);
  }
}

std::optional<ReckonedSample> LiveReckoning::update_present(const Receiver& receiver,
                                                            std::int64_t received_ns,
                                                            Output& output) {
  const double now_s = receiver.now_s();
  if (!present_ || now_s < t_ + kTuning.least_step_s) {
    return std::nullopt;
  }
  t_ = now_s;
  follow_commands(receiver.inputs_at(t_, present_commands_.shifts_s(), x_, late_));
  if (!present_) {
    return std::nullopt;
  }
  advance(receiver, t_);
  return sample(receiver, received_ns, output);
}

bool LiveReckoning::fill_late_inputs(std::span<double> x) const {
  if (late_.empty()) {
    return true;
  }
  if (!present_) {
    return false;
  }
  for (const std::size_t input : late_) {
    const auto state = std::ranges::find(states_, input);
    x[input] = state == states_.end()
                   ? row_x_[input]
                   : present_->velocity(static_cast<std::size_t>(state - states_.begin()));
  }
  return true;
}

// The gravest fault of a velocity of the log; a gyro has no say.
void LiveReckoning::note_faults() {
  VelocityFault gravest = VelocityFault::none;
  bool is_log = false;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const VelocityFault fault = reckoning_->fault(i);
    if (std::isfinite(x_[states_[i]]) &&
        std::ranges::find(settings_.rates, i) == settings_.rates.end()) {
      is_log = true;
      gravest = std::max(gravest, fault);
    }
  }
  if (!is_log) {
    return;
  }
  fault_ = gravest;
  if (fault_ != VelocityFault::implausible || !std::isfinite(believed_s_)) {
    believed_s_ = t_;
  }
  health_.largest_step = std::max(health_.largest_step, reckoning_->step());
  if (fault_ == VelocityFault::zero || fault_ == VelocityFault::frozen) {
    const bool goes_on = t_ <= invalid_until_s_ + configuration_.plan.gap_s;
    invalid_from_s_ = goes_on ? invalid_from_s_ : t_;
    invalid_until_s_ = t_;
  }
}

void LiveReckoning::note_loss(Output& output) {
  const bool is_lost = holds_ && present()->silent_s() > usual_silence_s() + kTuning.least_outage_s;
  if (std::exchange(is_lost_, is_lost) != is_lost) {
    output.event(is_lost ? fmt::format("at {:.1f} s: {}; velocities are unknown", t_, kLost)
                         : fmt::format("at {:.1f} s: velocities are known again", t_));
  }
}

// Of the velocity log alone: one that began beside silent commands counts from their return on.
void LiveReckoning::note_outage(Output& output) {
  const bool is_faulty = fault_ == VelocityFault::zero || fault_ == VelocityFault::frozen;
  const double silent_s =
      fault_ == VelocityFault::implausible ? t_ - believed_s_ : present()->silent_s();
  const double usual_s = usual_silence_s();
  const double lasted_s = t_ - silent_s - measured_s_;
  if (silent_s <= usual_s && is_out_) {
    is_out_ = false;
    ++health_.outages;
    health_.longest_s = std::max(health_.longest_s, lasted_s);
    output.event(fmt::format(
        "at {:.1f} s: velocities are measured again, after {:.1f} s; step {:.1f} standard "
        "deviations",
        t_, lasted_s, reckoning_->step()));
  } else if (!is_out_ && !holds_ &&
             (silent_s > usual_s + kTuning.least_outage_s || (is_faulty && silent_s > 0.0))) {
    is_out_ = true;
    output.event(fmt::format("at {:.1f} s: {}; velocities are reckoned", t_,
                             late_.empty() ? fault_text(fault_) : kNoPose));
  }
  measured_s_ = t_ - silent_s;
}

bool LiveReckoning::is_invalid(double t) const {
  if (!late_.empty()) {
    return false;
  }
  const DerivativeSettings& derivative = configuration_.plan.derivative;
  return t + derivative.ahead_s() >= invalid_from_s_ && t - derivative.back_s() <= invalid_until_s_;
}

ReckoningHealth LiveReckoning::health() const {
  ReckoningHealth health = health_;
  if (const DeadReckoning* const reckoning = present();
      reckoning != nullptr && reckoning->started()) {
    for (std::size_t i = 0; !is_lost_ && i < health.velocities.size(); ++i) {
      health.velocities[i].value = reckoning->velocity(i);
      health.velocities[i].deviation = reckoning->deviation(i);
    }
    if (settings_.planar && !is_lost_) {
      const std::array<double, 2> current = reckoning->current();
      health.current_speed = std::hypot(current[0], current[1]);
      if (heading_.is_known(t_) && health.current_speed > 0.0) {
        health.current_direction = heading_.reading_of(current) / kRadPerDegree;
      }
    }
    health.silent_s = reckoning->silent_s();
    const std::string_view fault = late_.empty() ? fault_text(fault_) : kNoPose;
    health.fault = is_lost_ ? kLost : is_out_ ? fault : "";
  } else {
    health.velocities.clear();
  }
  return health;
}

}  // namespace kelpie::live
