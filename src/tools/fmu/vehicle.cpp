// SPDX-License-Identifier: Apache-2.0
#include "fmu/vehicle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "kelpie/core/error.hpp"
#include "motion/states.hpp"

namespace kelpie::fmu {
namespace {

constexpr std::array<std::string_view, 3> kPose{"position_x", "position_y", "heading"};
constexpr std::array<std::size_t, 3> kPlanarAxes{0, 1, 5};  // surge, sway, yaw rate
constexpr double kShortestS = 0.0005;  // between commands that an actuator takes, two at a time

// Every predicted change of velocity counts: in a simulation that goes on for hours, a velocity
// held would never answer a command.
OpenLoop simulated(const TrainedModel& model) {
  OpenLoop loop = open_loop(model);
  loop.kept.clear();
  return loop;
}

// Commands that were logged late belong to their own moment here; commands that act late keep the
// delay.
Actuator with_delay(Actuator actuator, const Alignment& alignment) {
  actuator.delay_s += std::max(-alignment.lag_s, 0.0);
  return actuator;
}

}  // namespace

Vehicle::Vehicle(TrainedModel model)
    : model_(std::make_shared<const TrainedModel>(std::move(model))),
      rollout_(simulated(*model_), {.step_s = kStepS, .between = CommandPath::linear}),
      x_(model_->input_names.size()) {
  for (std::size_t i = 0; i < model_->input_names.size(); ++i) {
    const bool is_state =
        std::ranges::find(rollout_.integrated(), i) != rollout_.integrated().end();
    variables_.push_back({model_->input_names[i], is_state ? Role::state : Role::input});
  }
  const Alignment& alignment = model_->alignment;
  for (std::size_t k = 0; k < alignment.commands.size(); ++k) {
    const Actuator actuator =
        with_delay(alignment.actuators.empty() ? Actuator{} : alignment.actuators[k], alignment);
    const auto input = std::ranges::find(model_->input_names, alignment.commands[k]);
    if (!actuator.none() && input != model_->input_names.end()) {
      const auto place = static_cast<std::size_t>(input - model_->input_names.begin());
      driven_.push_back({.input = place, .actuator = ActuatorState(actuator, 1.0 / kShortestS)});
      variables_[place].start = actuator.neutral;
    }
  }
  add_pose();
  const std::vector<std::string> targets = model_->target_names();
  target_count_ = targets.size();
  for (const std::string& target : targets) {
    require(std::ranges::find(model_->input_names, target) == model_->input_names.end(), target,
            "is an input and a target: a simulated vehicle has the name once");
    variables_.push_back({target, Role::acceleration});
  }
  for (const Variable& variable : variables_) {
    values_.push_back(variable.start);
  }
}

void Vehicle::add_pose() {
  std::array<std::optional<std::size_t>, 3> found{};
  for (const std::size_t input : rollout_.integrated()) {
    const std::optional<std::size_t> axis = velocity_axis(model_->input_names[input]);
    for (std::size_t k = 0; k < found.size(); ++k) {
      if (axis == kPlanarAxes[k]) {
        found[k] = input;
      }
    }
  }
  if (!std::ranges::all_of(found, [](const auto& input) { return input.has_value(); })) {
    return;
  }
  pose_ = Pose{*found[0], *found[1], *found[2], variables_.size()};
  for (const std::string_view name : kPose) {
    require(std::ranges::find(model_->input_names, name) == model_->input_names.end(),
            std::string(name), "is an input of the model: the name is that of the vehicle's pose");
    variables_.push_back({std::string(name), Role::state});
  }
}

void Vehicle::start(double t) {
  t_ = t;
  for (Driven& driven : driven_) {
    driven.actuator.rest();
    driven.taken_s = -std::numeric_limits<double>::infinity();
  }
  take_effects(t_);
  rollout_.start(x_);
  predict();
}

void Vehicle::advance(double dt_s) {
  require(dt_s >= 0.0 && std::isfinite(dt_s) && dt_s <= Rollout::kMostSteps * kStepS, "step",
          "has to be finite, not negative, and at most a million steps of the integrator");
  const auto steps = static_cast<int>(std::ceil(dt_s / kStepS * (1.0 - 1e-12)));
  take_effects(t_);
  rollout_.advance(x_, 0.0);  // commands without an actuator jump
  const double begin = t_;
  for (int step = 1; step <= steps; ++step) {
    const double step_s = dt_s / steps;
    t_ = begin + step * step_s;
    take_effects(t_);
    rollout_.advance(x_, step_s);
    move_pose(step_s);
    take_states();
  }
  predict();
}

// The inputs of the model at the time t: every command behind its actuator. Commands of shorter
// steps than kShortestS are passed over: an actuator keeps a limited number for its delay.
void Vehicle::take_effects(double t) {
  std::copy_n(values_.begin(), x_.size(), x_.begin());
  for (Driven& driven : driven_) {
    const double command = values_[driven.input];
    const bool is_soon = t > driven.taken_s && t - driven.taken_s < kShortestS;
    if (std::isfinite(command) && !is_soon) {
      driven.effect = driven.actuator.next(command, t);
      driven.taken_s = t;
    }
    if (std::isfinite(command)) {
      x_[driven.input] = driven.effect;
    }
  }
}

// The pose after a step, with the velocities in the middle of the step.
void Vehicle::move_pose(double dt_s) {
  if (!pose_) {
    return;
  }
  const auto middle = [&](std::size_t input) {
    return 0.5 * (values_[input] + rollout_.inputs()[input]);
  };
  const double u = middle(pose_->surge);
  const double v = middle(pose_->sway);
  const double turn = dt_s * middle(pose_->yaw_rate);
  const std::span<double, 3> pose(values_.data() + pose_->place, 3);
  const double course = pose[2] + 0.5 * turn;
  pose[0] += dt_s * (u * std::cos(course) - v * std::sin(course));
  pose[1] += dt_s * (u * std::sin(course) + v * std::cos(course));
  pose[2] += turn;
}

void Vehicle::take_states() {
  for (const std::size_t input : rollout_.integrated()) {
    values_[input] = x_[input] = rollout_.inputs()[input];
  }
}

void Vehicle::predict() {
  model_->predict(x_, std::span(values_).last(target_count_));
}

bool Vehicle::is_finite() const {
  return std::ranges::all_of(values_, [](double value) { return std::isfinite(value); });
}

}  // namespace kelpie::fmu
