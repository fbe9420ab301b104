// SPDX-License-Identifier: Apache-2.0
#include "live/live_reckoning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/seconds.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/model/trained_model.hpp"
#include "live/tuning.hpp"
#include "motion/states.hpp"

namespace kelpie::live {
namespace {

constexpr std::size_t kMostStates = 6;  // of a DeadReckoning
constexpr std::size_t kRollRate = 3;    // the first angular velocity

// Surge, sway and yaw rate first: motion in the plane. Other angular velocities are a gyro's.
DeadReckoningSettings settings_of(const std::vector<std::string>& names) {
  DeadReckoningSettings settings;
  std::vector<std::optional<std::size_t>> axes;
  for (const std::string& name : names) {
    axes.push_back(velocity_axis(name));
  }
  constexpr std::size_t kYawRate = 5;
  settings.planar = axes.size() >= 3 && axes[0] == 0U && axes[1] == 1U && axes[2] == kYawRate;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const bool is_rate = axes[i] && *axes[i] >= kRollRate;
    if (is_rate && names.size() > 1) {
      settings.rates.push_back(i);
    }
  }
  return settings;
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
                                                      const Alignment& alignment) {
  if (!model.ready()) {
    return nullptr;
  }
  try {
    return std::make_shared<const ReckoningModel>(
        ReckoningModel{.loop = open_loop(model.trained(), OpenLoopPart::steady),
                       .alignment = std::make_shared<const Alignment>(alignment)});
  } catch (const InputError&) {
    return nullptr;  // too few samples for the equations
  }
}

LiveReckoning::LiveReckoning(const Configuration& configuration)
    : configuration_(configuration),
      states_(find_states(configuration.settings.shared.states, configuration.plan.inputs,
                          configuration.plan.targets.size())),
      commands_(configuration.plan.inputs, configuration.plan.rate_hz, configuration.plan.gap_s),
      x_(configuration.plan.inputs.size()) {
  if (states_.size() > kMostStates) {
    states_.clear();
  }
  for (const std::size_t state : states_) {
    names_.push_back(configuration.plan.inputs[state]);
    health_.velocities.push_back({.name = names_.back()});
  }
  settings_ = settings_of(names_);
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
  return true;
}

void LiveReckoning::use(std::shared_ptr<const ReckoningModel> model) {
  waits_ = false;
  if (!model) {
    return;
  }
  model_ = std::move(model);
  if (reckoning_) {
    reckoning_->use(model_->loop);
  } else {
    settings_.between = acts_at_once() ? CommandPath::held : CommandPath::linear;
    reckoning_ = std::make_unique<DeadReckoning>(model_->loop, settings_);
  }
}

// A command holds until the next one; what an actuator makes of commands, and what is measured,
// changes in between.
bool LiveReckoning::acts_at_once() const {
  const StreamPlan& plan = configuration_.plan;
  for (std::size_t i = 0; i < plan.inputs.size(); ++i) {
    const bool is_velocity = std::ranges::find(states_, i) != states_.end();
    const auto source = std::ranges::find(plan.sources, plan.inputs[i], &StreamPlan::Source::name);
    if (!is_velocity && source != plan.sources.end() && source->between == Interpolation::line) {
      return false;
    }
  }
  return model_->alignment->actuators.empty();
}

void LiveReckoning::begin_anew(const Receiver& receiver) {
  restarts_ = receiver.stream().restarts();
  *reckoning_ = DeadReckoning(model_->loop, settings_);
  t_ = -std::numeric_limits<double>::infinity();
  asked_s_ = t_;
  waits_ = false;
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
  commands_.use(model_->alignment);
  const bool has_commands = receiver.newest(commands_.shifts_s(), x_, states_);
  const bool is_new = take_velocities(receiver);
  const double now_s = std::max(receiver.now_s(), t_);
  if (!has_commands || (!is_new && now_s < t_ + kTuning.least_step_s)) {
    return std::nullopt;
  }
  commands_.act(x_, now_s);
  t_ = now_s;
  reckoning_->update(x_, t_);
  if (!reckoning_->started()) {
    return std::nullopt;
  }
  if (is_new) {
    note_faults();
  }
  note_outage(output);
  return ReckonedSample{.stamp_ns = received_ns,
                        .data_ns = *receiver.origin_ns() + nanoseconds(t_),
                        .names = names_,
                        .reckoning = *reckoning_};
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
  health_.largest_step = std::max(health_.largest_step, reckoning_->step());
  if (fault_ == VelocityFault::zero || fault_ == VelocityFault::frozen) {
    const bool goes_on = t_ <= invalid_until_s_ + configuration_.plan.gap_s;
    invalid_from_s_ = goes_on ? invalid_from_s_ : t_;
    invalid_until_s_ = t_;
  }
}

void LiveReckoning::note_outage(Output& output) {
  const bool is_faulty = fault_ == VelocityFault::zero || fault_ == VelocityFault::frozen;
  const double silent_s = reckoning_->silent_s();
  if (silent_s == 0.0 && is_out_) {
    is_out_ = false;
    ++health_.outages;
    health_.longest_s = std::max(health_.longest_s, silent_s_);
    output.event(fmt::format(
        "at {:.1f} s: velocities are measured again, after {:.1f} s; step {:.1f} standard "
        "deviations",
        t_, silent_s_, reckoning_->step()));
  } else if (!is_out_ && (silent_s > kTuning.least_outage_s || (is_faulty && silent_s > 0.0))) {
    is_out_ = true;
    output.event(fmt::format("at {:.1f} s: {}; velocities are reckoned", t_, fault_text(fault_)));
  }
  silent_s_ = silent_s;
}

bool LiveReckoning::is_invalid(double t) const {
  const DerivativeSettings& derivative = configuration_.plan.derivative;
  return t + derivative.ahead_s() >= invalid_from_s_ && t - derivative.back_s() <= invalid_until_s_;
}

ReckoningHealth LiveReckoning::health() const {
  ReckoningHealth health = health_;
  if (reckoning_ && reckoning_->started()) {
    for (std::size_t i = 0; i < health.velocities.size(); ++i) {
      health.velocities[i].value = reckoning_->velocity(i);
      health.velocities[i].deviation = reckoning_->deviation(i);
    }
    health.silent_s = reckoning_->silent_s();
    health.fault = is_out_ ? std::string(fault_text(fault_)) : "";
  } else {
    health.velocities.clear();
  }
  return health;
}

}  // namespace kelpie::live
