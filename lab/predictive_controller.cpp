// SPDX-License-Identifier: Apache-2.0
// Model predictive control by the real-time iteration (M. Diehl, H. G. Bock, J. P. Schlöder, SIAM
// Journal on Control and Optimization 43(5), 2005): one quadratic program per period, linearised
// along the last plan. Without offset by a force beside the model, estimated by a Kalman filter
// (G. Pannocchia, J. B. Rawlings, AIChE Journal 49(2), 2003).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>

#include "core/angle.hpp"
#include "core/bounded_minimum.hpp"
#include "lab/controllers.hpp"
#include "simulator/parameters.hpp"

namespace kelpie::lab {
namespace {

// Pose, velocity, thrusts, and the force that the model doesn't know of, three each.
constexpr int kMotionStates = 12;
constexpr int kSeen = 9;  // the first of them are measured
using Motion = Eigen::Matrix<double, kMotionStates, 1>;
using MotionSlope = Eigen::Matrix<double, kMotionStates, kMotionStates>;
using InputSlope = Eigen::Matrix<double, kMotionStates, 3>;

// Periods in which a thrust stays as it is: 3 s in all.
constexpr std::array kBlocks{1, 1, 2, 3, 4, 5, 6, 8};
constexpr Eigen::Index kVariables = 3 * kBlocks.size();
using Slopes = Eigen::Matrix<double, kMotionStates, kVariables>;
using Programme = Eigen::Matrix<double, kVariables, kVariables>;
using Variables = Eigen::Matrix<double, kVariables, 1>;

// Errors that cost 1 per period, found on the nominal vehicle (docs/measured/applications.md).
const Eigen::Vector3d kCostlyPose{0.01, 0.01, 0.015};      // m, m, rad
const Eigen::Vector3d kCostlyVelocity{0.03, 0.03, 0.045};  // m/s, m/s, rad/s
constexpr double kCostlyThrust = 1.0;                      // N away from the reference's
constexpr double kLastCost = 10.0;                         // factor at the horizon's end

// Standard deviations: of the sensors, and of what a period adds.
const Eigen::Vector3d kPoseDeviation{0.005, 0.005, 0.002};         // m, m, rad
const Eigen::Vector3d kVelocityDeviation{0.0005, 0.0005, 0.0004};  // m/s, m/s, rad/s
const Eigen::Vector3d kForceWalk{0.05, 0.05, 0.02};                // N, N, N m
constexpr double kThrustDeviation = 0.001;                         // N
constexpr double kVelocityWalk = 0.0001;                           // m/s, rad/s
constexpr double kLastingS = 10.0;  // over which the force that an outage finds is averaged

// The nominal vehicle with its rotors' lag, a period ahead.
class NominalMotion {
 public:
  explicit NominalMotion(NominalModel model)
      : model_(std::move(model)),
        followed_(model_.lag_s > 0.0 ? 1.0 - std::exp(-kControlPeriodS / model_.lag_s) : 1.0) {}

  Motion after(const Motion& now, const Eigen::Vector3d& thrusts) const {
    Motion later = now;
    later.segment<3>(6) += followed_ * (thrusts - now.segment<3>(6));
    const Eigen::Vector3d pushes =
        model_.by_thrust * 0.5 * (now.segment<3>(6) + later.segment<3>(6)) + now.tail<3>();
    later.segment<3>(3) +=
        kControlPeriodS *
        (pushes - model_.resistance(now.segment<3>(3))).cwiseQuotient(model_.mass);
    const Eigen::Vector3d velocity = 0.5 * (now.segment<3>(3) + later.segment<3>(3));
    const Eigen::Rotation2Dd to_world(now(2) + 0.5 * kControlPeriodS * velocity.z());
    later.head<2>() += kControlPeriodS * (to_world * velocity.head<2>());
    later(2) += kControlPeriodS * velocity.z();
    return later;
  }

  // By central differences.
  std::pair<MotionSlope, InputSlope> slopes(const Motion& now,
                                            const Eigen::Vector3d& thrusts) const {
    constexpr double kAside = 1e-5;
    std::pair<MotionSlope, InputSlope> slopes;
    for (Eigen::Index i = 0; i < kMotionStates; ++i) {
      const Motion aside = kAside * Motion::Unit(i);
      slopes.first.col(i) =
          (after(now + aside, thrusts) - after(now - aside, thrusts)) / (2.0 * kAside);
    }
    for (Eigen::Index i = 0; i < 3; ++i) {
      const Eigen::Vector3d aside = kAside * Eigen::Vector3d::Unit(i);
      slopes.second.col(i) =
          (after(now, thrusts + aside) - after(now, thrusts - aside)) / (2.0 * kAside);
    }
    return slopes;
  }

  const NominalModel& model() const { return model_; }

 private:
  NominalModel model_;
  double followed_;
};

// An extended Kalman filter.
class MotionFilter {
 public:
  explicit MotionFilter(const NominalMotion& motion) : motion_(motion) {}

  // What is measured after a period of these thrusts.
  const Motion& update(const Sensed& sensed, const Eigen::Vector3d& thrusts) {
    Eigen::Matrix<double, kSeen, 1> seen;
    seen << sensed.pose, sensed.velocity, motion_.model().thrusts(sensed.rotors_rps);
    if (sensed.silent) {
      return bridge(sensed, thrusts);
    }
    if (!started_) {
      started_ = true;
      state_.head<kSeen>() = seen;
      covariance_.setZero();
      covariance_.diagonal() << variances(), kForceWalk.cwiseAbs2();
      return state_;
    }
    const MotionSlope slope = motion_.slopes(state_, thrusts).first;
    state_ = motion_.after(state_, thrusts);
    Motion added;
    added << Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(kVelocityWalk),
        Eigen::Vector3d::Constant(kThrustDeviation), kForceWalk;
    covariance_ = slope * covariance_ * slope.transpose();
    covariance_.diagonal() += added.cwiseAbs2();
    Eigen::Matrix<double, kSeen, 1> surprise = seen - state_.head<kSeen>();
    surprise(2) = wrapped(surprise(2));
    Eigen::Matrix<double, kSeen, kSeen> spread = covariance_.topLeftCorner<kSeen, kSeen>();
    spread.diagonal() += variances();
    const Eigen::Matrix<double, kSeen, kMotionStates> gain =
        spread.llt().solve(covariance_.topRows<kSeen>());
    state_ += gain.transpose() * surprise;
    covariance_ -= (gain.transpose() * covariance_.topRows<kSeen>()).eval();
    covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
    lasting_ += kControlPeriodS / kLastingS * (state_.tail<3>() - lasting_);
    return state_;
  }

 private:
  // The equation of motion with the force of the last while, beside what goes on being measured.
  const Motion& bridge(const Sensed& sensed, const Eigen::Vector3d& thrusts) {
    started_ = false;
    state_.tail<3>() = lasting_;
    state_ = motion_.after(state_, thrusts);
    state_(2) = sensed.pose.z();
    state_(5) = sensed.velocity.z();
    state_.segment<3>(6) = motion_.model().thrusts(sensed.rotors_rps);
    return state_;
  }

  static Eigen::Matrix<double, kSeen, 1> variances() {
    Eigen::Matrix<double, kSeen, 1> deviations;
    deviations << kPoseDeviation, kVelocityDeviation, Eigen::Vector3d::Constant(kThrustDeviation);
    return deviations.cwiseAbs2();
  }

  const NominalMotion& motion_;
  bool started_ = false;
  Motion state_ = Motion::Zero();
  Eigen::Vector3d lasting_ = Eigen::Vector3d::Zero();  // N, N, N m: the force, averaged
  MotionSlope covariance_ = MotionSlope::Zero();
};

// The reference a period later, with its present accelerations.
Reference continued(const Reference& now) {
  Reference later = now;
  later.speed += kControlPeriodS * now.speed_rate;
  later.yaw_rate += kControlPeriodS * now.yaw_rate_rate;
  const double turn = kControlPeriodS * 0.5 * (now.yaw_rate + later.yaw_rate);
  const double way = kControlPeriodS * 0.5 * (now.speed + later.speed);
  const double heading = now.pose.z() + 0.5 * turn;
  later.pose += Pose2(way * std::cos(heading), way * std::sin(heading), turn);
  return later;
}

class PredictiveController final : public Controller {
 public:
  explicit PredictiveController(const NominalModel& model) : motion_(model), filter_(motion_) {
    most_ = model.thrusts(model.most_rps);
    least_ = model.thrusts(-model.most_rps);
  }

  Eigen::Vector3d update(const Reference& reference, const Sensed& sensed) override {
    const Motion now = filter_.update(sensed, plan_.head<3>());
    shift();
    plan_ += improvement(now, reference);
    return motion_.model().speeds(plan_.head<3>());
  }

 private:
  // The plan as it goes on a period later.
  void shift() {
    std::size_t block = 0;
    for (; block + 1 < kBlocks.size() && kBlocks[block] == 1; ++block) {
      thrusts_of(block) = thrusts_of(block + 1).eval();
    }
  }

  Eigen::VectorBlock<Variables, 3> thrusts_of(std::size_t block) {
    return plan_.segment<3>(3 * static_cast<Eigen::Index>(block));
  }

  // Of the plan, by the quadratic program along its way.
  Variables improvement(const Motion& now, Reference reference) {
    Programme h = Programme::Zero();
    Variables g = Variables::Zero();
    Slopes by_plan = Slopes::Zero();
    Motion motion = now;
    std::size_t block = 0;
    for (int step = 0, end = kBlocks[0]; block < kBlocks.size(); ++step) {
      const Eigen::Vector3d thrusts = thrusts_of(block);
      const Eigen::Index place = 3 * static_cast<Eigen::Index>(block);
      const Eigen::Vector3d away = steady_thrusts(reference, now.tail<3>()) - thrusts;
      constexpr double kWeight = 1.0 / (kCostlyThrust * kCostlyThrust);
      h.diagonal().segment<3>(place).array() += kWeight;
      g.segment<3>(place) += kWeight * away;

      const auto [slope, by_input] = motion_.slopes(motion, thrusts);
      by_plan = (slope * by_plan).eval();
      by_plan.middleCols<3>(place) += by_input;
      motion = motion_.after(motion, thrusts);
      reference = continued(reference);
      const bool block_ends = step + 1 == end;
      block += block_ends ? 1 : 0;
      end += block_ends && block < kBlocks.size() ? kBlocks[block] : 0;
      add_error(motion, reference, by_plan, block == kBlocks.size() ? kLastCost : 1.0, h, g);
    }
    return solved(h, g);
  }

  static void add_error(const Motion& motion, const Reference& reference, const Slopes& by_plan,
                        double factor, Programme& h, Variables& g) {
    Eigen::Matrix<double, 6, 1> error;
    error << reference.pose - motion.head<3>(),
        Eigen::Vector3d(reference.speed, 0.0, reference.yaw_rate) - motion.segment<3>(3);
    error(2) = wrapped(error(2));
    Eigen::Matrix<double, 6, 1> weights;
    weights << kCostlyPose, kCostlyVelocity;
    weights = factor * weights.cwiseAbs2().cwiseInverse();
    const Eigen::Matrix<double, kVariables, 6> weighed =
        by_plan.topRows<6>().transpose() * weights.asDiagonal();
    h += weighed * by_plan.topRows<6>();
    g += weighed * error;
  }

  // The thrusts that keep the vehicle on the reference, as far as they reach.
  Eigen::Vector3d steady_thrusts(const Reference& reference, const Eigen::Vector3d& force) const {
    const NominalModel& model = motion_.model();
    const Eigen::Vector3d acceleration(reference.speed_rate, 0.0, reference.yaw_rate_rate);
    const Eigen::Vector3d forces =
        model.mass.cwiseProduct(acceleration) +
        model.resistance(Eigen::Vector3d(reference.speed, 0.0, reference.yaw_rate)) - force;
    return (model.by_thrust.inverse() * forces).cwiseMax(least_).cwiseMin(most_);
  }

  Variables solved(const Programme& h, const Variables& g) const {
    const Variables lower = least_.replicate<kBlocks.size(), 1>() - plan_;
    const Variables upper = most_.replicate<kBlocks.size(), 1>() - plan_;
    const auto numbers = [](const auto& values) {
      return std::span(values.data(), static_cast<std::size_t>(values.size()));
    };
    Variables change;
    bounded_minimum(numbers(h), numbers(g), numbers(lower), numbers(upper),
                    {change.data(), static_cast<std::size_t>(change.size())});
    return change;
  }

  NominalMotion motion_;
  MotionFilter filter_;
  Eigen::Vector3d most_;                // N
  Eigen::Vector3d least_;               // N
  Variables plan_ = Variables::Zero();  // N, a thrust per thruster and block
};

}  // namespace

std::unique_ptr<Controller> make_predictive(const NominalModel& model) {
  return std::make_unique<PredictiveController>(model);
}

}  // namespace kelpie::lab
