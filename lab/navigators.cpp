// SPDX-License-Identifier: Apache-2.0
#include "lab/navigators.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/angle.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "kelpie/model/trained_model.hpp"
#include "simulator/parameters.hpp"
#include "study/open_loop_study.hpp"

namespace kelpie::lab {
namespace {

constexpr double kTilt = 0.1 * kRadPerDegree;  // rad, of an IMU

class FilterNavigator final : public Navigator {
 public:
  FilterNavigator(const OpenLoop& loop, const DeadReckoningSettings& settings)
      : reckoning_(loop, settings), noise_(loop.noise) {}

  std::unique_ptr<Navigator> clone() const override {
    return std::make_unique<FilterNavigator>(*this);
  }
  void update(const SensedRow& row) override {
    reckoning_.update(row.x, row.time_s);
    if (reckoning_.silent_s() == 0.0) {
      heading_ = reckoning_.heading();
    }
  }
  void use(const OpenLoop& model) override {
    reckoning_.use(model);
    noise_ = model.noise;
  }
  double velocity(std::size_t state) const override { return reckoning_.velocity(state); }
  std::optional<std::array<double, 4>> position_covariance() const override {
    const std::array<double, 4> p = reckoning_.drift().covariance_m2;
    const double c = std::cos(heading_);
    const double s = std::sin(heading_);
    const double across = p[1] * (c * c - s * s) + (p[3] - p[0]) * c * s;
    return std::array{p[0] * c * c + 2.0 * p[1] * c * s + p[3] * s * s, across, across,
                      p[0] * s * s - 2.0 * p[1] * c * s + p[3] * c * c};
  }

  std::optional<std::array<double, 4>> velocity_covariance() const override {
    return std::array{reckoning_.covariance(0, 0) + noise_[0] * noise_[0],
                      reckoning_.covariance(0, 1), reckoning_.covariance(1, 0),
                      reckoning_.covariance(1, 1) + noise_[1] * noise_[1]};
  }
  double step() const override { return reckoning_.step(); }
  std::optional<bool> believes() const override {
    return reckoning_.fault(0) == VelocityFault::none && reckoning_.fault(1) == VelocityFault::none;
  }

 private:
  DeadReckoning reckoning_;
  std::vector<double> noise_;
  double heading_ = 0.0;  // when the velocities fell silent
};

// The model alone, started afresh wherever it hears velocities.
class RolloutNavigator final : public Navigator {
 public:
  explicit RolloutNavigator(const OpenLoop& loop) : loop_(loop), rollout_(loop, {}) {}

  std::unique_ptr<Navigator> clone() const override {
    return std::make_unique<RolloutNavigator>(*this);
  }
  void update(const SensedRow& row) override {
    const std::span<const double> x = row.x;
    if (std::isfinite(x[0])) {
      rollout_.start(x);
      silent_ = false;
    } else {
      if (!silent_) {
        begin(x);
      }
      rollout_.advance(x, row.time_s - time_s_);
    }
    last_.assign(x.begin(), x.end());
    time_s_ = row.time_s;
  }
  void use(const OpenLoop& model) override {
    loop_ = model;
    rollout_ = Rollout(loop_, {});
  }
  double velocity(std::size_t state) const override { return rollout_.velocity(state); }

 private:
  void begin(std::span<const double> x) {
    RolloutSettings settings;
    if (std::isfinite(x[2])) {
      settings.measured = {2};
    }
    rollout_ = Rollout(loop_, settings);
    rollout_.start(last_);
    silent_ = true;
  }

  OpenLoop loop_;
  Rollout rollout_;
  std::vector<double> last_;
  bool silent_ = false;
  double time_s_ = 0.0;
};

// Accelerations are those in the body, without the turning of the frame: of surge and sway alone.
class ImuNavigator final : public Navigator {
 public:
  std::unique_ptr<Navigator> clone() const override {
    return std::make_unique<ImuNavigator>(*this);
  }
  void update(const SensedRow& row) override {
    const bool silent = !std::isfinite(row.x[0]);
    if (silent && !silent_) {
      draw_tilt(row.time_s);
    }
    silent_ = silent;
    for (std::size_t axis = 0; axis < velocity_.size(); ++axis) {
      const double now = row.accelerations[axis] + gravity_[axis];
      velocity_[axis] = silent
                            ? velocity_[axis] + 0.5 * (before_[axis] + now) * (row.time_s - time_s_)
                            : row.x[axis];
      before_[axis] = now;
    }
    yaw_rate_ = row.x[2];
    time_s_ = row.time_s;
  }
  double velocity(std::size_t state) const override {
    return state < velocity_.size() ? velocity_[state] : yaw_rate_;
  }

 private:
  void draw_tilt(double time_s) {
    RandomStream random(static_cast<std::uint64_t>(std::llround(1000.0 * time_s)), "tilt");
    for (std::size_t axis = 0; axis < gravity_.size(); ++axis) {
      gravity_[axis] = simulator::kGravity * kTilt * random.normal();
      before_[axis] += gravity_[axis];
    }
  }

  std::array<double, 2> velocity_{};
  std::array<double, 2> before_{};
  std::array<double, 2> gravity_{};
  double yaw_rate_ = 0.0;
  double time_s_ = 0.0;
  bool silent_ = false;
};

// What the identified model's errors are not told to last, and no practice: a constant current
// explains what there is.
DeadReckoningSettings constant_current(const DeadReckoningSettings& like) {
  DeadReckoningSettings settings = like;
  settings.current_m_s = 0.3;
  settings.current_wander = 0.0;
  settings.practice_s = 0.0;
  return settings;
}

}  // namespace

NavigatorSet::NavigatorSet(const log::Dataset& data, const DeadReckoningSettings& settings)
    : data_(data),
      settings_(settings),
      model_(data.input_names, data.target_names,
             ModelSettings::from_preset("default", data.target_names.size())) {}

void NavigatorSet::learn(std::size_t row) {
  model_.update(data_.input(row), data_.target(row), data_.times_s[row]);
  rows_.push_back(row);
}

bool NavigatorSet::try_to_renew() {
  if (!model_.ready()) {
    return false;
  }
  try {
    renew();
  } catch (const InputError&) {
    return false;  // too few samples for the equations
  }
  return true;
}

void NavigatorSet::renew() {
  const TrainedModel trained = model_.trained();
  const OpenLoop loop = open_loop(trained, OpenLoopPart::steady);
  const bool first = navigators_.empty();
  std::size_t place = 0;
  const auto put = [&](std::string name, const OpenLoop& model, auto make) {
    if (first) {
      navigators_.push_back({std::move(name), make(model)});
    } else {
      navigators_[place++].navigator->use(model);
    }
  };
  const auto filter = [this](const OpenLoop& model) {
    return std::make_unique<FilterNavigator>(model, settings_);
  };
  const auto constant_filter = [this](const OpenLoop& model) {
    return std::make_unique<FilterNavigator>(model, constant_current(settings_));
  };
  const auto rollout = [](const OpenLoop& model) {
    return std::make_unique<RolloutNavigator>(model);
  };
  put("kelpie", loop, filter);
  for (const study::OpenLoopContender& one : study::open_loop_contenders(
           trained, loop, data_, {.label = {}, .training = rows_, .held_out = {}})) {
    if (one.name == "recursive least squares") {
      OpenLoop identified = one.loop;
      identified.noise = loop.noise;
      identified.error = loop.error;
      std::ranges::fill(identified.error_time_s, 0.0);
      put("constant-current Kalman filter", identified, constant_filter);
    }
    if (one.name == "kelpie" || !one.name.starts_with("kelpie")) {
      put(one.name == "kelpie" ? "kelpie, rollout alone" : one.name, one.loop, rollout);
    }
  }
  put("IMU alone", loop, [](const OpenLoop&) { return std::make_unique<ImuNavigator>(); });
}

}  // namespace kelpie::lab
