// SPDX-License-Identifier: Apache-2.0
#include "lab/navigators.hpp"

#include <algorithm>
#include <cmath>

#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/model/trained_model.hpp"
#include "study/open_loop_study.hpp"

namespace kelpie::lab {
namespace {

class FilterNavigator final : public Navigator {
 public:
  FilterNavigator(const OpenLoop& loop, const DeadReckoningSettings& settings)
      : reckoning_(loop, settings), noise_(loop.noise) {}

  std::unique_ptr<Navigator> clone() const override {
    return std::make_unique<FilterNavigator>(*this);
  }
  void update(std::span<const double> x, double t) override {
    reckoning_.update(x, t);
    if (reckoning_.silent_s() == 0.0) {
      heading_ = reckoning_.heading();
    }
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
  void update(std::span<const double> x, double t) override {
    if (std::isfinite(x[0])) {
      rollout_.start(x);
      silent_ = false;
    } else {
      if (!silent_) {
        begin(x);
      }
      rollout_.advance(x, t - time_s_);
    }
    last_.assign(x.begin(), x.end());
    time_s_ = t;
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

OpenLoop learned_loop(const log::Dataset& data, const study::Split& split, TrainedModel& trained) {
  DynamicsModel model(data.input_names, data.target_names,
                      ModelSettings::from_preset("default", data.target_names.size()));
  for (const std::size_t row : split.training) {
    model.update(data.input(row), data.target(row), data.times_s[row]);
  }
  model.learn_held_back();
  trained = model.trained();
  return open_loop(trained, OpenLoopPart::steady);
}

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

std::vector<NamedNavigator> make_navigators(const log::Dataset& data, const study::Split& split,
                                            const DeadReckoningSettings& settings) {
  TrainedModel trained;
  const OpenLoop loop = learned_loop(data, split, trained);
  std::vector<NamedNavigator> all;
  all.push_back({"kelpie", std::make_unique<FilterNavigator>(loop, settings)});
  for (const study::OpenLoopContender& one :
       study::open_loop_contenders(trained, loop, data, split)) {
    if (one.name == "recursive least squares") {
      OpenLoop identified = one.loop;
      identified.noise = loop.noise;
      identified.error = loop.error;
      std::ranges::fill(identified.error_time_s, 0.0);
      all.push_back({"constant-current Kalman filter",
                     std::make_unique<FilterNavigator>(identified, constant_current(settings))});
    }
    if (one.name == "kelpie" || !one.name.starts_with("kelpie")) {
      all.push_back({one.name == "kelpie" ? "kelpie, rollout alone" : one.name,
                     std::make_unique<RolloutNavigator>(one.loop)});
    }
  }
  return all;
}

}  // namespace kelpie::lab
