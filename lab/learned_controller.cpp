// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "lab/controllers.hpp"
#include "lab/reallocation.hpp"
#include "lab/reckoners.hpp"

namespace kelpie::lab {
namespace {

constexpr std::size_t kAxes = 3;
constexpr std::size_t kInputs = 6;
constexpr int kSteps = 4;             // of Gauss and Newton
constexpr double kDamping = 1e-3;     // of them, in the largest squared slope: thrust has none at 0
constexpr double kLongestStep = 2.0;  // rev/s
constexpr double kAheadS = 0.4;       // from the last sample learned to where a command acts
constexpr double kStrange = 0.98;     // novelty from which the model isn't believed
constexpr double kWide = 0.5;         // of the most that thrusters give: half width of an interval
constexpr double kDisturbanceS = 0.3;  // over which the disturbance's noise is averaged
constexpr double kCorrectionS = 0.5;   // over which what the model adds is averaged
constexpr double kSmall = 0.05;        // of the most that thrusters give: what is averaged longer
constexpr double kSlowest = 0.05;      // share of the speed with which the least follows
constexpr double kMargin = 0.05;    // of the most that thrusters give: trusted beyond what is seen
constexpr double kObservedS = 1.0;  // over which missing forces are averaged
constexpr double kTrustS = 1.0;     // over which trust comes and goes
constexpr double kUnsolved = 0.3;   // of the most that thrusters give: left over by the solution

using Inputs = std::array<double, kInputs>;

Inputs inputs_of(const Eigen::Vector3d& velocity, const Eigen::Vector3d& rotors) {
  return {velocity(0), velocity(1), velocity(2), rotors(0), rotors(1), rotors(2)};
}

class LearnedController final : public Controller {
 public:
  LearnedController(const NominalModel& nominal, DynamicsModel model, bool reallocates)
      : nominal_(nominal),
        model_(std::move(model)),
        pid_(PidGains{}),
        reckoner_(make_learned_reckoner(model_)),
        reallocation_(nominal),
        reallocates_(reallocates) {
    const Eigen::Vector3d most_thrust = nominal.most_rps.cwiseAbs2().cwiseProduct(Eigen::Vector3d(
        nominal.thrusters[0].forward, nominal.thrusters[1].forward, nominal.thrusters[2].forward));
    authority_ = (nominal.by_thrust.cwiseAbs() * most_thrust).cwiseQuotient(nominal.mass);
  }

  Eigen::Vector3d update(const Reference& reference, const Sensed& measured) override {
    learn(measured);
    reallocate(measured.rotors_rps);
    const Sensed sensed = reckoner_->complete(measured);
    const TrackingError error = tracking_error(reference, sensed);
    const Eigen::Vector3d wanted = error.acceleration + pid_.update(error, kControlPeriodS);
    const Eigen::Vector3d start = reallocation_.allocate(nominal_.mass.cwiseProduct(wanted) +
                                                         nominal_.resistance(error.wanted));
    const Eigen::Vector3d solved = solve(error.wanted, start, wanted);
    trust_ += kControlPeriodS / kTrustS * ((believed_ ? 1.0 : 0.0) - trust_);
    correct(trust_ * (reallocation_.forces(solved) - reallocation_.forces(start)) -
            (1.0 - trust_) * observed_);
    Eigen::Vector3d commands = reallocation_.allocate(reallocation_.forces(start) + correction_);
    if (at_limit(commands)) {
      pid_.saturated();
    }
    ++periods_;
    fallen_ += 1.0 - trust_;
    return commands;
  }

  double fallback_share() const override {
    return periods_ > 0 ? fallen_ / static_cast<double>(periods_) : 0.0;
  }

 private:
  bool at_limit(const Eigen::Vector3d& commands) const {
    return (commands.cwiseAbs().array() >= nominal_.most_rps.array()).any();
  }

  // Within a margin of what is observed to be missing from the nominal model's forces; what is
  // quick and small is averaged longer, or noise would be amplified.
  void correct(const Eigen::Vector3d& wanted) {
    for (Eigen::Index i = 0; i < 3; ++i) {
      const double most = authority_(i) * nominal_.mass(i);
      const double safe =
          std::clamp(wanted(i), -observed_(i) - kMargin * most, -observed_(i) + kMargin * most);
      const double away = safe - correction_(i);
      const double haste = std::clamp(std::abs(away) / (kSmall * most), kSlowest, 1.0);
      correction_(i) += kControlPeriodS / kCorrectionS * haste * away;
    }
  }

  // The force that the nominal model doesn't know of.
  void observe(const Sensed& middle, const Eigen::Vector3d& acceleration) {
    const Eigen::Vector3d force = nominal_.mass.cwiseProduct(acceleration) +
                                  nominal_.resistance(middle.velocity) -
                                  reallocation_.forces(middle.rotors_rps);
    observed_ += kControlPeriodS / kObservedS * (force - observed_);
  }

  // What has been named needs no observer any more.
  void reallocate(const Eigen::Vector3d& rotors) {
    if (reallocates_) {
      const Eigen::Vector3d lost = reallocation_.look(model_.diagnosis(), rotors);
      observed_ += lost;
      correction_ -= lost;
      pid_.hand_over(lost.cwiseQuotient(nominal_.mass));
    }
  }

  void learn(const Sensed& sensed) {
    if (const auto sample = window_.add(sensed)) {
      const auto& [middle, acceleration] = *sample;
      observe(middle, acceleration);
      if (++measured_ % 2 == 0) {
        model_.update(inputs_of(middle.velocity, middle.rotors_rps),
                      std::array{acceleration(0), acceleration(1), acceleration(2)}, middle.time_s);
      }
    }
  }

  Eigen::Vector3d solve(const Eigen::Vector3d& velocity, const Eigen::Vector3d& start,
                        const Eigen::Vector3d& wanted) {
    std::array<Prediction, kAxes> predicted;
    model_.predict(inputs_of(velocity, start), predicted, kAheadS);
    for (Eigen::Index i = 0; i < 3; ++i) {
      disturbance_(i) += kControlPeriodS / kDisturbanceS *
                         (predicted[static_cast<std::size_t>(i)].disturbance - disturbance_(i));
    }
    Eigen::Vector3d commands = start;
    std::array<double, kAxes> y{};
    std::array<double, kAxes * kInputs> jacobian{};
    Eigen::Vector3d missing = Eigen::Vector3d::Zero();
    for (int step = 0; step <= kSteps; ++step) {
      model_.predict_with_jacobian(inputs_of(velocity, commands), y, jacobian);
      missing = wanted - disturbance_ - Eigen::Vector3d(y[0], y[1], y[2]);
      if (step < kSteps) {
        commands += change(jacobian, missing);
        commands = commands.cwiseMax(-nominal_.most_rps).cwiseMin(nominal_.most_rps);
      }
    }
    model_.predict(inputs_of(velocity, commands), predicted, kAheadS);
    believed_ = commands.allFinite() && is_known(predicted) &&
                (at_limit(commands) ||
                 (missing.cwiseAbs().array() <= kUnsolved * authority_.array()).all());
    return commands.allFinite() ? commands : start;
  }

  // δn of (JᵀWJ + λ) δn = JᵀW missing, accelerations weighed by what the thrusters can give.
  Eigen::Vector3d change(const std::array<double, kAxes * kInputs>& jacobian,
                         const Eigen::Vector3d& missing) const {
    Eigen::Matrix3d slope;
    for (Eigen::Index i = 0; i < 3; ++i) {
      for (Eigen::Index k = 0; k < 3; ++k) {
        slope(i, k) =
            jacobian[static_cast<std::size_t>(i) * kInputs + 3 + static_cast<std::size_t>(k)] /
            authority_(i);
      }
    }
    const Eigen::Matrix3d normal = slope.transpose() * slope;
    const double damping = kDamping * normal.diagonal().maxCoeff() + 1e-9;
    const Eigen::Vector3d step = (normal + damping * Eigen::Matrix3d::Identity())
                                     .ldlt()
                                     .solve(slope.transpose() * missing.cwiseQuotient(authority_));
    return step.cwiseMax(-kLongestStep).cwiseMin(kLongestStep);
  }

  bool is_known(const std::array<Prediction, kAxes>& predicted) const {
    for (std::size_t i = 0; i < kAxes; ++i) {
      const double half_width = 0.5 * (predicted[i].upper - predicted[i].lower);
      const double most = kWide * authority_(static_cast<Eigen::Index>(i));
      if (!(predicted[i].novelty < kStrange) || !(half_width < most)) {
        return false;
      }
    }
    return true;
  }

  NominalModel nominal_;
  DynamicsModel model_;
  Pid pid_;
  std::unique_ptr<Reckoner> reckoner_;
  Reallocation reallocation_;
  bool reallocates_;
  SlopeWindow window_;
  Eigen::Vector3d disturbance_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d observed_ = Eigen::Vector3d::Zero();    // N, N m
  Eigen::Vector3d correction_ = Eigen::Vector3d::Zero();  // N, N m
  Eigen::Vector3d authority_;  // m/s², rad/s²: the most that the thrusters give
  std::size_t measured_ = 0;
  bool believed_ = false;
  double trust_ = 0.0;
  double fallen_ = 0.0;
  std::size_t periods_ = 0;
};

}  // namespace

std::optional<std::pair<Sensed, Eigen::Vector3d>> SlopeWindow::add(const Sensed& sensed) {
  if (sensed.silent) {
    seen_ = 0;
    return {};
  }
  ring_[seen_++ % kCount] = sensed;
  if (seen_ < kCount) {
    return {};
  }
  const auto at = [&](std::size_t i) -> const Sensed& { return ring_[(seen_ + i) % kCount]; };
  const Sensed& middle = at(kCount / 2);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double squares = 0.0;
  for (std::size_t i = 0; i < kCount; ++i) {
    const double away_s = at(i).time_s - middle.time_s;
    sum += away_s * at(i).velocity;
    squares += away_s * away_s;
  }
  return std::pair{middle, Eigen::Vector3d(sum / squares)};
}

DynamicsModel untaught_model() {
  ModelSettings settings = ModelSettings::from_preset("default", kAxes);
  settings.assign("buffer", "300");
  settings.assign("fine", "0");  // smoother derivatives (docs/howto/controller.md)
  return {{"u", "v", "r", "th1", "th2", "th3"}, {"udot", "vdot", "rdot"}, settings};
}

std::unique_ptr<Controller> make_learned(const NominalModel& nominal, DynamicsModel model,
                                         bool reallocates) {
  return std::make_unique<LearnedController>(nominal, std::move(model), reallocates);
}

}  // namespace kelpie::lab
