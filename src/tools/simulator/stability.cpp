// SPDX-License-Identifier: Apache-2.0
#include "simulator/stability.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "motion/states.hpp"

namespace kelpie::simulator {
namespace {

constexpr double kLeastStepS = 1e-4;
constexpr double kStepRatio = 1.25;
constexpr int kHalvings = 4;          // of the ratio
constexpr double kGrowthShare = 1.2;  // of the vehicle's own growth
constexpr double kGrowthRate = 0.01;  // 1/s beyond

// Rotation vector, velocity, last velocity, filtered acceleration times the step.
using Disturbance = Eigen::Matrix<double, 21, 1>;

EngineState disturbed(const EngineState& at, const Disturbance& by, double step_s) {
  EngineState state = at;
  const Eigen::Vector3d rotation = by.head<3>();
  if (rotation.norm() > 0.0) {
    state.attitude =
        at.attitude * Eigen::Quaterniond(Eigen::AngleAxisd(rotation.norm(), rotation.normalized()));
  }
  state.velocity += by.segment<6>(3);
  state.last_velocity += by.segment<6>(9);
  state.filtered_acceleration += by.segment<6>(15) / step_s;
  return state;
}

Disturbance between(const EngineState& from, const EngineState& to, double step_s) {
  const Eigen::AngleAxisd turn(from.attitude.conjugate() * to.attitude);
  return (Disturbance() << turn.angle() * turn.axis(), to.velocity - from.velocity,
          to.last_velocity - from.last_velocity,
          step_s * (to.filtered_acceleration - from.filtered_acceleration))
      .finished();
}

// The entries of a disturbance on axes that move.
std::vector<Eigen::Index> moving(const std::array<bool, 6>& free) {
  std::vector<Eigen::Index> places;
  for (Eigen::Index turn = 0; turn < 3; ++turn) {
    if (free[static_cast<std::size_t>(3 + turn)]) {
      places.push_back(turn);
    }
  }
  for (const Eigen::Index first : {3, 9, 15}) {
    for (Eigen::Index axis = 0; axis < 6; ++axis) {
      if (free[static_cast<std::size_t>(axis)]) {
        places.push_back(first + axis);
      }
    }
  }
  return places;
}

EngineBody without(EngineBody body, EngineTerm term) {
  switch (term) {
    case EngineTerm::added_mass:
      body.added_mass.setZero();
      break;
    case EngineTerm::coriolis:
      body.coriolis = false;
      break;
    case EngineTerm::linear_damping:
      body.linear_damping.setZero();
      break;
    case EngineTerm::quadratic_damping:
      body.quadratic_damping.setZero();
      break;
    case EngineTerm::restoring:
      body.net_weight_n = 0.0;
      body.weight_moment_nm.setZero();
      break;
  }
  return body;
}

class Bound {
 public:
  Bound(const Engine& engine, const EngineBody& body, std::span<const EngineState> points)
      : engine_(engine), body_(body), points_(points.begin(), points.end()) {
    points_.push_back(EngineState::at(Eigen::Quaterniond::Identity(), Vector6::Zero()));
    // The vehicle's own growth, by the most exact engine at a short step.
    const EngineRun exact(engines().front(), body, kLeastStepS);
    for (const EngineState& point : points_) {
      own_.push_back(std::max(0.0, fastest_growth(exact, point).per_s));
    }
  }

  // Growth beyond the vehicle's own; at most 0: stable.
  Growth excess(double step_s) const {
    const EngineRun run(engine_, body_, step_s);
    Growth worst{-std::numeric_limits<double>::infinity(), 0};
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Growth growth = fastest_growth(run, points_[i]);
      const double beyond = growth.per_s - kGrowthShare * own_[i] - kGrowthRate;
      if (beyond > worst.per_s) {
        worst = {beyond, growth.axis};
      }
    }
    return worst;
  }

  std::optional<double> largest() const {
    if (excess(kLeastStepS).per_s > 0.0) {
      return std::nullopt;
    }
    double stable = kLeastStepS;
    while (stable < StepLimit::kMostS && excess(stable * kStepRatio).per_s <= 0.0) {
      stable *= kStepRatio;
    }
    double ratio = kStepRatio;
    for (int halving = 0; halving < kHalvings && stable < StepLimit::kMostS; ++halving) {
      ratio = std::sqrt(ratio);
      stable *= excess(stable * ratio).per_s <= 0.0 ? ratio : 1.0;
    }
    return std::min(stable, StepLimit::kMostS);
  }

 private:
  Engine engine_;
  EngineBody body_;
  std::vector<EngineState> points_;
  std::vector<double> own_;
};

}  // namespace

const char* term_text(EngineTerm term) {
  constexpr std::array kTexts{"added mass", "Coriolis forces", "linear drag", "quadratic drag",
                              "restoring forces"};
  return kTexts[static_cast<std::size_t>(term)];
}

std::string axis_text(std::size_t axis) {
  return std::string(kAxisTexts.at(axis));
}

Growth fastest_growth(const EngineRun& run, const EngineState& at) {
  constexpr double kSmall = 1e-6;
  const std::vector<Eigen::Index> places = moving(run.body().free);
  const auto count = static_cast<Eigen::Index>(places.size());
  Eigen::MatrixXd matrix(count, count);
  for (Eigen::Index column = 0; column < count; ++column) {
    const Disturbance by = kSmall * Disturbance::Unit(places[static_cast<std::size_t>(column)]);
    const auto stepped = [&](const Disturbance& change) {
      return run.next(disturbed(at, change, run.step_s()), Vector6::Zero());
    };
    matrix.col(column) = between(stepped(-by), stepped(by), run.step_s())(places) / (2.0 * kSmall);
  }
  if (!matrix.allFinite()) {
    return {std::numeric_limits<double>::infinity(), 0};
  }
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(matrix);
  Eigen::Index worst = 0;
  const double radius = solver.eigenvalues().cwiseAbs().maxCoeff(&worst);
  Growth growth{std::log(radius) / run.step_s(), 0};
  double most = -1.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index place = places[static_cast<std::size_t>(i)];
    const double part = std::abs(solver.eigenvectors()(i, worst));
    if (place >= 3 && place < 9 && part > most) {
      most = part;
      growth.axis = static_cast<std::size_t>(place - 3);
    }
  }
  return growth;
}

StepLimit step_limit(const Engine& engine, const EngineBody& body,
                     std::span<const EngineState> points) {
  const Bound bound(engine, body, points);
  StepLimit limit{.stable = bound.excess(engine.step_s).per_s <= 0.0, .largest_s = bound.largest()};
  const double now = limit.largest_s.value_or(0.0);
  if (now >= StepLimit::kMostS) {
    return limit;
  }
  limit.axis = bound.excess(now > 0.0 ? now * kStepRatio : engine.step_s).axis;
  double best = now * kStepRatio;
  for (const EngineTerm term :
       {EngineTerm::added_mass, EngineTerm::coriolis, EngineTerm::linear_damping,
        EngineTerm::quadratic_damping, EngineTerm::restoring}) {
    const double step = Bound(engine, without(body, term), points).largest().value_or(0.0);
    if (step > best) {
      best = step;
      limit.term = term;
    }
  }
  return limit;
}

}  // namespace kelpie::simulator
