// SPDX-License-Identifier: Apache-2.0
#include "identify/output_error.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "core/bounded_minimum.hpp"
#include "core/normal_equations.hpp"
#include "core/quantile.hpp"
#include "identify/tuning.hpp"

namespace kelpie {
namespace {

using Eigen::Index;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

// Steps in units of a parameter's own error stay within.
constexpr double kFarthest = 1e8;

double huber(double error) {
  const double size = std::abs(error);
  return size < kPath.huber_sigmas ? 0.5 * size * size
                                   : kPath.huber_sigmas * (size - 0.5 * kPath.huber_sigmas);
}

double huber_weight(double error) {
  return std::min(1.0, kPath.huber_sigmas / std::max(std::abs(error), 1e-300));
}

// Σ ρ; infinite for a path that leaves all bounds.
double cost_of(const PoseErrors& errors, const std::vector<PathPiece>& pieces,
               const PoseNoise& noise) {
  double cost = 0.0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    for (Index at = 0; at < errors[i].cols(); ++at) {
      for (Index part = 0; part < 3; ++part) {
        if (std::isfinite(pieces[i].poses(part, at)) && std::isfinite(noise(part))) {
          cost += huber(errors[i](part, at) / noise(part));
        }
      }
    }
  }
  if (!std::isfinite(cost)) {
    cost = kNotCounted;
  }
  return cost;
}

// Normal equations of the parameters and of the start of each piece.
struct PathNormal {
  struct Start {
    Matrix6d own;
    Eigen::Matrix<double, 6, Eigen::Dynamic> shared;  // start × parameters
    Vector6d pull;
  };
  Eigen::MatrixXd own;
  Eigen::VectorXd pull;
  std::vector<Start> starts;
};

PathNormal normal_equations(const std::vector<PathPiece>& pieces, const std::vector<Index>& sought,
                            const PoseNoise& noise, const PathEstimate& at) {
  const auto count = static_cast<Index>(sought.size());
  PathNormal normal{Eigen::MatrixXd::Zero(count, count), Eigen::VectorXd::Zero(count), {}};
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const PathStates path =
        drive_piece(pieces[i], at.parameters, at.starts[i], at.between, sought, true);
    const Index rows = pieces[i].times_s.size();
    Eigen::VectorXd errors = Eigen::VectorXd::Zero(3 * rows);
    Eigen::MatrixXd jacobian = path.jacobian;
    for (Index k = 0; k < 3 * rows; ++k) {
      const double error = pieces[i].poses(k % 3, k / 3) - path.states(k % 3, k / 3);
      const double scaled = std::isfinite(error) ? error / noise(k % 3) : 0.0;
      const double weight = std::isfinite(error) ? std::sqrt(huber_weight(scaled)) : 0.0;
      errors(k) = weight * scaled;
      jacobian.row(k) *= weight / noise(k % 3);
    }
    const auto by_parameters = jacobian.leftCols(count);
    const auto by_start = jacobian.rightCols<6>();
    normal.own += by_parameters.transpose() * by_parameters;
    normal.pull += by_parameters.transpose() * errors;
    normal.starts.push_back({by_start.transpose() * by_start, by_start.transpose() * by_parameters,
                             by_start.transpose() * errors});
  }
  return normal;
}

// The same after elimination of the starts (Schur complement), each damped.
PathNormal without_starts(const PathNormal& normal, double damping) {
  PathNormal reduced{normal.own, normal.pull, {}};
  for (const PathNormal::Start& start : normal.starts) {
    Matrix6d own = start.own;
    add_relative_ridge(own, damping);
    const auto factor = own.ldlt();
    reduced.own -= start.shared.transpose() * factor.solve(start.shared);
    reduced.pull -= start.shared.transpose() * factor.solve(start.pull);
  }
  return reduced;
}

// Drags and ratios are not negative; m33 shrinks to a fifth at most in one step.
double least_value(Index place, Index all, double value) {
  const auto is_at = [&](std::size_t other) { return place == static_cast<Index>(other); };
  if (is_at(PlanarPlace::yaw_inertia)) {
    return 0.2 * value;
  }
  const bool is_drag = place >= static_cast<Index>(PlanarPlace::linear_drag) &&
                       place < static_cast<Index>(PlanarPlace::constant_force);
  const auto each = static_cast<Index>(PlanarPlace::per_thruster);
  const Index of_thruster = place - PathPlace::thruster(0);
  const bool is_ratio = of_thruster >= 0 && of_thruster < all - PathPlace::count(0) &&
                        of_thruster % each == PathPlace::ratio;
  return is_drag || is_ratio ? 0.0 : -kNotCounted;
}

// A damped step with bounds, each parameter in units of its own error.
PathEstimate stepped(const PathNormal& normal, const std::vector<Index>& sought, double damping,
                     const PathEstimate& at) {
  const PathNormal reduced = without_starts(normal, damping);
  const Index count = reduced.pull.size();
  const Eigen::VectorXd unit =
      (reduced.own.diagonal().cwiseMax(1e-12 * normal.own.diagonal()).array() + 1e-300).rsqrt();
  Eigen::MatrixXd own = unit.asDiagonal() * reduced.own * unit.asDiagonal();
  own.diagonal().array() += damping;
  const Eigen::VectorXd pull = unit.cwiseProduct(reduced.pull);
  Eigen::VectorXd lower(count);
  for (Index k = 0; k < count; ++k) {
    const Index place = sought[static_cast<std::size_t>(k)];
    const double value = at.parameters(place);
    lower(k) = std::clamp((least_value(place, at.parameters.size(), value) - value) / unit(k),
                          -kFarthest, 0.0);
  }
  const Eigen::VectorXd upper = Eigen::VectorXd::Constant(count, kFarthest);
  Eigen::VectorXd step(count);
  const auto numbers = [](const auto& matrix) {
    return std::span<const double>(matrix.data(), static_cast<std::size_t>(matrix.size()));
  };
  bounded_minimum(numbers(own), numbers(pull), numbers(lower), numbers(upper),
                  std::span<double>(step.data(), static_cast<std::size_t>(count)));
  step = step.cwiseProduct(unit);
  PathEstimate next = at;
  next.parameters(sought) += step;
  for (std::size_t i = 0; i < normal.starts.size(); ++i) {
    const PathNormal::Start& start = normal.starts[i];
    Matrix6d own_start = start.own;
    add_relative_ridge(own_start, damping);
    next.starts[i] += own_start.ldlt().solve(start.pull - start.shared * step);
  }
  return next;
}

bool is_definite(const Eigen::VectorXd& parameters) {
  const double coupling = parameters(PlanarPlace::sway_yaw_inertia);
  const double yaw = parameters(PlanarPlace::yaw_inertia);
  const double sway = 1.0 + parameters(PlanarPlace::sway_inertia) * yaw;
  return sway > 0.0 && sway * yaw > coupling * coupling;
}

void minimise_with(const std::vector<PathPiece>& pieces, const std::vector<Index>& sought,
                   const PoseNoise& noise, double least_gain, PathEstimate& at) {
  double damping = kPath.first_damping;
  double cost = cost_of(pose_errors(pieces, at), pieces, noise);
  for (int step = 0; step < kPath.most_steps; ++step) {
    const PathNormal normal = normal_equations(pieces, sought, noise, at);
    double gain = -1.0;
    for (int trial = 0; trial < kPath.most_trials && gain < 0.0; ++trial) {
      PathEstimate next = stepped(normal, sought, damping, at);
      const double next_cost = is_definite(next.parameters)
                                   ? cost_of(pose_errors(pieces, next), pieces, noise)
                                   : kNotCounted;
      damping *= next_cost <= cost ? 0.1 : 10.0;
      if (next_cost <= cost) {
        gain = cost - next_cost;
        at = std::move(next);
        cost = next_cost;
      }
    }
    if (gain < least_gain * cost) {
      return;
    }
  }
}

}  // namespace

PoseErrors pose_errors(const std::vector<PathPiece>& pieces, const PathEstimate& estimate) {
  PoseErrors errors;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    errors.emplace_back(pieces[i].poses - drive_piece(pieces[i], estimate.parameters,
                                                      estimate.starts[i], estimate.between, {},
                                                      false)
                                              .states.topRows<3>());
  }
  return errors;
}

PoseNoise noise_of(const PoseErrors& errors, const PoseNoise& counted) {
  std::array<std::vector<double>, 2> sizes;  // of positions, of headings
  for (const Eigen::Matrix3Xd& of_piece : errors) {
    for (Index k = 0; k < of_piece.size(); ++k) {
      if (std::isfinite(of_piece(k))) {
        sizes[k % 3 < 2 ? 0 : 1].push_back(std::abs(of_piece(k)));
      }
    }
  }
  PoseNoise noise = counted;
  for (Index part = 0; part < 3; ++part) {
    std::vector<double>& all = sizes[part < 2 ? 0 : 1];
    if (std::isfinite(counted(part)) && !all.empty()) {
      noise(part) = std::max(robust_deviation(all), std::numeric_limits<double>::min());
    }
  }
  return noise;
}

PoseNoise minimise_output_errors(const std::vector<PathPiece>& pieces,
                                 const std::vector<Index>& sought, const PoseNoise& counted,
                                 double least_gain, PathEstimate& estimate) {
  PoseNoise noise = noise_of(pose_errors(pieces, estimate), counted);
  for (int round = 0; round < kPath.noise_rounds; ++round) {
    minimise_with(pieces, sought, noise, least_gain, estimate);
    noise = noise_of(pose_errors(pieces, estimate), counted);
  }
  return noise;
}

Eigen::MatrixXd output_information(const std::vector<PathPiece>& pieces,
                                   const std::vector<Index>& sought, const PoseNoise& noise,
                                   const PathEstimate& estimate) {
  return without_starts(normal_equations(pieces, sought, noise, estimate), 0.0).own;
}

}  // namespace kelpie
