// SPDX-License-Identifier: Apache-2.0
#include "study/manoeuvre.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "core/eigen.hpp"
#include "core/text.hpp"
#include "identify/six_axis_structure.hpp"
#include "simulator/decomposition.hpp"
#include "study/tuning.hpp"

namespace kelpie::study {
namespace {

constexpr double kLeastShare = 1e-3;   // of the strongest axis: weaker axes are not driven
constexpr double kLeastReached = 0.5;  // of a push along an axis

// Amplitudes and times of the dictionary.
struct Dictionary {
  std::vector<const char*> axes{"surge", "sway", "yaw"};
  std::vector<double> amplitudes{0.4, 0.7, 1.0};
  std::vector<double> periods_s{5.0, 10.0, 20.0};
  std::vector<double> sequences{0.7, 1.0};
  std::vector<double> holds_s{1.5, 3.0, 6.0};  // shortest hold of a pseudo-random sequence
  double sequence_s = 18.0;
  std::uint64_t seeds = 3;  // of sequences
};

constexpr std::array kSixAxisNames{"surge", "sway", "heave", "roll", "pitch", "yaw"};

int percent(double share) {
  return static_cast<int>(std::lround(100.0 * share));
}

void add_axis(const ThrusterPush& push, std::size_t axis, const char* name,
              const Dictionary& dictionary, std::vector<Manoeuvre>& list) {
  for (const double amplitude : dictionary.amplitudes) {
    for (const double sense : {1.0, -1.0}) {
      std::vector<double> direction(push.axes(), 0.0);
      direction[axis] = sense;
      const std::vector<double> there = push.speeds(direction, amplitude);
      direction[axis] = -sense;
      const std::vector<double> back = push.speeds(direction, amplitude);
      const std::vector<double> rest(there.size(), 0.0);
      const int share = percent(sense * amplitude);
      for (const double period_s : dictionary.periods_s) {
        const double half_s = 0.5 * period_s;
        list.push_back({fmt::format("{} step, {:g} s, {} %", name, half_s, share),
                        {{half_s, there}, {half_s, rest}}});
        list.push_back({fmt::format("{} doublet, {:g} s, {} %", name, period_s, share),
                        {{half_s, there}, {half_s, back}}});
      }
    }
  }
}

void add_axes(const ThrusterPush& push, const Dictionary& dictionary,
              std::vector<Manoeuvre>& list) {
  for (std::size_t axis = 0; axis < dictionary.axes.size(); ++axis) {
    if (push.reaches(axis)) {
      add_axis(push, axis, dictionary.axes[axis], dictionary, list);
    }
  }
}

void add_turns(const ThrusterPush& push, const Dictionary& dictionary,
               std::vector<Manoeuvre>& list) {
  if (!push.reaches(0) || !push.reaches(push.axes() - 1)) {
    return;
  }
  for (const double amplitude : dictionary.amplitudes) {
    for (const double turn : {0.3, 0.8}) {
      for (const double ahead : {1.0, -1.0}) {
        std::vector<double> direction(push.axes(), 0.0);
        direction.front() = ahead;
        direction.back() = turn;
        const std::vector<double> left = push.speeds(direction, amplitude);
        direction.back() = -turn;
        const std::vector<double> right = push.speeds(direction, amplitude);
        const int share = percent(ahead * amplitude);
        list.push_back({fmt::format("circle, turn {:g}, {} %", turn, share), {{12.0, left}}});
        list.push_back({fmt::format("circle, turn {:g}, {} %", -turn, share), {{12.0, right}}});
        list.push_back({fmt::format("zig-zag, turn {:g}, {} %", turn, share),
                        {{4.0, left}, {4.0, right}, {4.0, left}, {4.0, right}}});
      }
    }
  }
}

void add_thrusters(const ThrusterRange& range, const Dictionary& dictionary,
                   std::vector<Manoeuvre>& list) {
  const std::size_t thrusters = range.most.size();
  for (std::size_t i = 0; i < thrusters; ++i) {
    for (const double amplitude : dictionary.amplitudes) {
      for (const double sense : {1.0, -1.0}) {
        std::vector<double> there(thrusters, 0.0);
        std::vector<double> back(thrusters, 0.0);
        there[i] = amplitude * range.full(i, sense);
        back[i] = amplitude * range.full(i, -sense);
        for (const double period_s : dictionary.periods_s) {
          list.push_back({fmt::format("doublet of thruster {}, {:g} s, {} %", i + 1, period_s,
                                      percent(sense * amplitude)),
                          {{0.5 * period_s, there}, {0.5 * period_s, back}}});
        }
      }
    }
  }
}

// Every thruster by itself, and all at once by sequences of their own.
void add_sequences(const ThrusterRange& range, const Dictionary& dictionary,
                   std::vector<Manoeuvre>& list) {
  const std::size_t thrusters = range.most.size();
  for (const double amplitude : dictionary.sequences) {
    for (const double hold_s : dictionary.holds_s) {
      for (std::uint64_t seed = 1; seed <= dictionary.seeds; ++seed) {
        for (std::size_t only = 0; only <= thrusters; ++only) {
          const bool all = only == thrusters;
          Manoeuvre sequence{all ? fmt::format("sequence {} of all thrusters, {:g} s, {} %", seed,
                                               hold_s, percent(amplitude))
                                 : fmt::format("sequence {} of thruster {}, {:g} s, {} %", seed,
                                               only + 1, hold_s, percent(amplitude))};
          RandomStream random(seed, "sequence");
          for (double t = 0.0; t < dictionary.sequence_s; t += hold_s) {
            std::vector<double> speeds(thrusters, 0.0);
            for (std::size_t i = 0; i < thrusters; ++i) {
              const double sign = random.uniform(-1.0, 1.0);
              speeds[i] = all || only == i ? amplitude * range.full(i, sign) : 0.0;
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
    : ThrusterPush(std::move(range)) {
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
  const Eigen::MatrixXd inverse = simulator::pseudo_inverse(forces);
  forces_.assign(forces.data(), forces.data() + forces.size());
  inverse_.assign(inverse.data(), inverse.data() + inverse.size());
}

bool PlanarPush::reaches(std::size_t axis) const {
  const auto forces = columns_of(std::span<const double>(forces_), kPlanarAxes);
  return forces.row(static_cast<Eigen::Index>(axis)).norm() > kLeastShare * forces.norm();
}

std::vector<double> PlanarPush::speeds(std::span<const double> direction, double amplitude) const {
  const std::size_t thrusters = range_.most.size();
  const Eigen::VectorXd share =
      columns_of(std::span<const double>(inverse_), thrusters) * as_vector(direction);
  const double largest = share.cwiseAbs().maxCoeff();
  std::vector<double> speeds(thrusters, 0.0);
  for (std::size_t i = 0; largest > 0.0 && i < thrusters; ++i) {
    const double part = share(static_cast<Eigen::Index>(i)) / largest;
    speeds[i] = amplitude * std::sqrt(std::abs(part)) * range_.full(i, part);
  }
  return speeds;
}

SixAxisPush::SixAxisPush(const SixAxisFit& fit, ThrusterRange range, double supply)
    : ThrusterPush(std::move(range)), dead_band_(fit.curve.dead_band) {
  const std::size_t count = fit.thrusters.size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t place = SixAxisPlace::thruster(i);
    ahead_.push_back(supply * fit.parameters[place].value);
    astern_.push_back(supply * fit.parameters[place + 1].value);
  }
  Eigen::MatrixXd arms = thruster_arms(fit.thrusters);
  const double arm = arms.bottomRows(3).norm() / std::max(arms.topRows(3).norm(), 1e-12);
  arms.bottomRows(3) /= std::max(arm, 1e-12);
  const Eigen::MatrixXd inverse = simulator::pseudo_inverse(arms);
  inverse_.assign(inverse.data(), inverse.data() + inverse.size());
  const Eigen::VectorXd reached = (arms * inverse).diagonal();
  reached_.assign(reached.begin(), reached.end());
  const auto value = [&](std::size_t place) { return fit.parameters[place].value; };
  // The vehicle is level: gravity acts along heave, the moments are those of the centres.
  Eigen::VectorXd holding = Eigen::VectorXd::Zero(6);
  holding(2) = -value(SixAxisPlace::net_weight);
  holding(3) = -value(SixAxisPlace::moment + 1) / std::max(arm, 1e-12);
  holding(4) = value(SixAxisPlace::moment) / std::max(arm, 1e-12);
  const Eigen::VectorXd thrusts = inverse * holding;
  holding_.assign(thrusts.begin(), thrusts.end());
}

double SixAxisPush::thrust_of(std::size_t thruster, double command) const {
  const double speed = std::max(0.0, std::abs(command) - dead_band_) / (1.0 - dead_band_);
  return command < 0.0 ? -astern_[thruster] * speed * speed : ahead_[thruster] * speed * speed;
}

double SixAxisPush::command_of(std::size_t thruster, double thrust) const {
  const double most = thrust < 0.0 ? astern_[thruster] : ahead_[thruster];
  const double speed = most > 0.0 ? std::sqrt(std::abs(thrust) / most) : 0.0;
  const double command = speed > 0.0 ? dead_band_ + (1.0 - dead_band_) * speed : 0.0;
  return std::clamp(thrust < 0.0 ? -command : command, range_.least[thruster],
                    range_.most[thruster]);
}

bool SixAxisPush::reaches(std::size_t axis) const {
  return reached_[axis] > kLeastReached;
}

std::vector<double> SixAxisPush::speeds(std::span<const double> direction, double amplitude) const {
  const std::size_t thrusters = range_.most.size();
  const Eigen::VectorXd share =
      columns_of(std::span<const double>(inverse_), thrusters) * as_vector(direction);
  double factor = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < thrusters; ++i) {
    const double part = share(static_cast<Eigen::Index>(i));
    if (part != 0.0) {
      factor = std::min(factor, thrust_of(i, range_.full(i, part)) / part);
    }
  }
  std::vector<double> commands(thrusters, 0.0);
  for (std::size_t i = 0; std::isfinite(factor) && i < thrusters; ++i) {
    commands[i] =
        command_of(i, amplitude * amplitude * factor * share(static_cast<Eigen::Index>(i)));
  }
  return commands;
}

std::vector<double> SixAxisPush::held(std::vector<double> speeds) const {
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    speeds[i] = command_of(i, thrust_of(i, speeds[i]) + holding_[i]);
  }
  return speeds;
}

std::vector<Manoeuvre> manoeuvres_for(const ThrusterPush& push) {
  const Dictionary dictionary;
  std::vector<Manoeuvre> list;
  add_axes(push, dictionary, list);
  add_turns(push, dictionary, list);
  add_thrusters(push.range(), dictionary, list);
  add_sequences(push.range(), dictionary, list);
  return list;
}

ManoeuvreDraws::ManoeuvreDraws(const ThrusterPush& push) : push_(push), random_(1, "manoeuvres") {}

Manoeuvre ManoeuvreDraws::next() {
  const auto steps = static_cast<double>(1 + random_.below(kTuning.plan.longest_hold));
  const double hold_s = kManoeuvreStepS * steps;
  const double most = std::min(kTuning.plan.most_holds, kTuning.plan.longest_draw_s / hold_s);
  const auto holds = 1 + random_.below(static_cast<std::uint64_t>(most));
  const std::vector<double> weights = drawn_weights();
  std::vector<std::string> axes;
  for (std::size_t axis = 0; axis < weights.size(); ++axis) {
    if (weights[axis] > 0.0) {
      axes.emplace_back(kSixAxisNames[axis]);
    }
  }
  Manoeuvre draw{fmt::format("{}, {} {} of {:g} s",
                             axes.empty() ? "all thrusters" : join_text(axes, " and "), holds,
                             holds == 1 ? "hold" : "holds", hold_s)};
  for (std::uint64_t i = 0; i < holds; ++i) {
    draw.parts.push_back({hold_s, drawn_speeds(weights)});
  }
  return draw;
}

// Half of the draws are along no axis.
std::vector<double> ManoeuvreDraws::drawn_weights() {
  std::vector<double> weights(push_.axes(), 0.0);
  const bool along_axes = random_.below(2) == 0;
  for (std::size_t axis = 0; along_axes && axis < weights.size(); ++axis) {
    if (push_.reaches(axis) && random_.below(2) == 0) {
      weights[axis] = random_.uniform();
    }
  }
  return weights;
}

std::vector<double> ManoeuvreDraws::drawn_speeds(const std::vector<double>& weights) {
  std::vector<double> wish = weights;
  double most = 0.0;
  for (double& level : wish) {
    level *= random_.uniform(-1.0, 1.0);
    most = std::max(most, std::abs(level));
  }
  if (most > 0.0) {
    return push_.speeds(wish, std::sqrt(most));
  }
  const ThrusterRange& range = push_.range();
  std::vector<double> speeds;
  for (std::size_t i = 0; i < range.most.size(); ++i) {
    speeds.push_back(random_.uniform(range.least[i], range.most[i]));
  }
  return speeds;
}

Manoeuvre at_amplitude(Manoeuvre draw, double amplitude, const ThrusterPush& push) {
  for (HeldSpeeds& part : draw.parts) {
    for (double& speed : part.speeds) {
      speed *= amplitude;
    }
    part.speeds = push.held(std::move(part.speeds));
  }
  draw.name += fmt::format(", {} %", percent(amplitude));
  return draw;
}

}  // namespace kelpie::study
