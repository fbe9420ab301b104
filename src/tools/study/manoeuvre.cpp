// SPDX-License-Identifier: Apache-2.0
#include "study/manoeuvre.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "core/eigen.hpp"
#include "kelpie/core/random.hpp"

namespace kelpie::study {
namespace {

constexpr std::array<const char*, kPlanarAxes> kPushNames{"surge", "sway", "yaw"};
constexpr std::array kAmplitudes{0.4, 0.7, 1.0};
constexpr std::array kPeriodsS{5.0, 10.0, 20.0};
constexpr std::array kHoldsS{1.5, 3.0, 6.0};  // shortest hold of a pseudo-random sequence
constexpr double kSequenceS = 18.0;
constexpr std::uint64_t kSequences = 3;
constexpr double kLeastShare = 1e-3;  // of the strongest axis: weaker axes are not driven

int percent(double share) {
  return static_cast<int>(std::lround(100.0 * share));
}

double full(const ThrusterRange& range, std::size_t thruster, double sign) {
  return sign < 0.0 ? range.least[thruster] : range.most[thruster];
}

std::vector<double> negated(const PlanarPush& push, const PlanarVector& direction,
                            double amplitude) {
  return push.speeds({-direction[0], -direction[1], -direction[2]}, amplitude);
}

void add_axes(const PlanarPush& push, std::vector<Manoeuvre>& list) {
  for (std::size_t axis = 0; axis < kPlanarAxes; ++axis) {
    if (!push.reaches(axis)) {
      continue;
    }
    for (const double amplitude : kAmplitudes) {
      for (const double sense : {1.0, -1.0}) {
        PlanarVector direction{};
        direction[axis] = sense;
        const std::vector<double> there = push.speeds(direction, amplitude);
        const std::vector<double> back = negated(push, direction, amplitude);
        const std::vector<double> rest(there.size(), 0.0);
        const int share = percent(sense * amplitude);
        for (const double period_s : kPeriodsS) {
          const double half_s = 0.5 * period_s;
          list.push_back({fmt::format("{} step, {:g} s, {} %", kPushNames[axis], half_s, share),
                          {{half_s, there}, {half_s, rest}}});
          list.push_back(
              {fmt::format("{} doublet, {:g} s, {} %", kPushNames[axis], period_s, share),
               {{half_s, there}, {half_s, back}}});
        }
      }
    }
  }
}

void add_turns(const PlanarPush& push, std::vector<Manoeuvre>& list) {
  if (!push.reaches(0) || !push.reaches(2)) {
    return;
  }
  for (const double amplitude : kAmplitudes) {
    for (const double turn : {0.3, 0.8}) {
      for (const double ahead : {1.0, -1.0}) {
        const std::vector<double> left = push.speeds({ahead, 0.0, turn}, amplitude);
        const std::vector<double> right = push.speeds({ahead, 0.0, -turn}, amplitude);
        const int share = percent(ahead * amplitude);
        list.push_back({fmt::format("circle, turn {:g}, {} %", turn, share), {{12.0, left}}});
        list.push_back({fmt::format("circle, turn {:g}, {} %", -turn, share), {{12.0, right}}});
        list.push_back({fmt::format("zig-zag, turn {:g}, {} %", turn, share),
                        {{4.0, left}, {4.0, right}, {4.0, left}, {4.0, right}}});
      }
    }
  }
}

void add_thrusters(const ThrusterRange& range, std::vector<Manoeuvre>& list) {
  const std::size_t thrusters = range.most.size();
  for (std::size_t i = 0; i < thrusters; ++i) {
    for (const double amplitude : kAmplitudes) {
      for (const double sense : {1.0, -1.0}) {
        std::vector<double> there(thrusters, 0.0);
        std::vector<double> back(thrusters, 0.0);
        there[i] = amplitude * full(range, i, sense);
        back[i] = amplitude * full(range, i, -sense);
        for (const double period_s : kPeriodsS) {
          list.push_back({fmt::format("doublet of thruster {}, {:g} s, {} %", i + 1, period_s,
                                      percent(sense * amplitude)),
                          {{0.5 * period_s, there}, {0.5 * period_s, back}}});
        }
      }
    }
  }
}

// Every thruster by itself, and all at once by sequences of their own.
void add_sequences(const ThrusterRange& range, std::vector<Manoeuvre>& list) {
  const std::size_t thrusters = range.most.size();
  for (const double amplitude : {0.7, 1.0}) {
    for (const double hold_s : kHoldsS) {
      for (std::uint64_t seed = 1; seed <= kSequences; ++seed) {
        for (std::size_t only = 0; only <= thrusters; ++only) {
          const bool all = only == thrusters;
          Manoeuvre sequence{all ? fmt::format("sequence {} of all thrusters, {:g} s, {} %", seed,
                                               hold_s, percent(amplitude))
                                 : fmt::format("sequence {} of thruster {}, {:g} s, {} %", seed,
                                               only + 1, hold_s, percent(amplitude))};
          RandomStream random(seed, "sequence");
          for (double t = 0.0; t < kSequenceS; t += hold_s) {
            std::vector<double> speeds(thrusters, 0.0);
            for (std::size_t i = 0; i < thrusters; ++i) {
              const double sign = random.uniform(-1.0, 1.0);
              speeds[i] = all || only == i ? amplitude * full(range, i, sign) : 0.0;
            }
            sequence.parts.push_back({hold_s, std::move(speeds)});
          }
          list.push_back(std::move(sequence));
        }
      }
    }
  }
}

}  // namespace

double Manoeuvre::duration_s() const {
  double sum = 0.0;
  for (const HeldSpeeds& part : parts) {
    sum += part.duration_s;
  }
  return sum;
}

PlanarPush::PlanarPush(const PlanarVehicle& vehicle, ThrusterRange range)
    : range_(std::move(range)) {
  const auto count = static_cast<Eigen::Index>(vehicle.thrusters.size());
  Eigen::MatrixXd forces(static_cast<Eigen::Index>(kPlanarAxes), count);
  for (std::size_t i = 0; i < vehicle.thrusters.size(); ++i) {
    const PlanarThruster& thruster = vehicle.thrusters[i];
    const double most = std::max(thruster.forward * range_.most[i] * range_.most[i],
                                 thruster.reverse * range_.least[i] * range_.least[i]);
    forces.col(static_cast<Eigen::Index>(i)) =
        most *
        Eigen::Vector3d(std::cos(thruster.angle_rad), std::sin(thruster.angle_rad), thruster.arm_m);
  }
  const double arm = forces.row(2).norm() / std::max(forces.topRows(2).norm(), 1e-12);
  forces.row(2) /= std::max(arm, 1e-12);
  const Eigen::MatrixXd inverse = forces.completeOrthogonalDecomposition().pseudoInverse();
  forces_.assign(forces.data(), forces.data() + forces.size());
  inverse_.assign(inverse.data(), inverse.data() + inverse.size());
}

bool PlanarPush::reaches(std::size_t axis) const {
  const auto forces = columns_of(std::span<const double>(forces_), kPlanarAxes);
  return forces.row(static_cast<Eigen::Index>(axis)).norm() > kLeastShare * forces.norm();
}

std::vector<double> PlanarPush::speeds(const PlanarVector& direction, double amplitude) const {
  const std::size_t thrusters = range_.most.size();
  const Eigen::VectorXd share =
      columns_of(std::span<const double>(inverse_), thrusters) * as_vector(direction);
  const double largest = share.cwiseAbs().maxCoeff();
  std::vector<double> speeds(thrusters, 0.0);
  for (std::size_t i = 0; largest > 0.0 && i < thrusters; ++i) {
    const double part = share(static_cast<Eigen::Index>(i)) / largest;
    speeds[i] = amplitude * std::sqrt(std::abs(part)) * full(range_, i, part);
  }
  return speeds;
}

std::vector<Manoeuvre> manoeuvres_for(const PlanarPush& push) {
  std::vector<Manoeuvre> list;
  add_axes(push, list);
  add_turns(push, list);
  add_thrusters(push.range(), list);
  add_sequences(push.range(), list);
  return list;
}

}  // namespace kelpie::study
