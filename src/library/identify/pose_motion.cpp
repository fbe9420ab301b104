// SPDX-License-Identifier: Apache-2.0
#include "identify/pose_motion.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "identify/tuning.hpp"

namespace kelpie {
namespace {

using Eigen::Index;

constexpr Index kMunk = PlanarPlace::sway_inertia;
constexpr Index kSwayYawInertia = PlanarPlace::sway_yaw_inertia;
constexpr Index kYawInertia = PlanarPlace::yaw_inertia;
constexpr Index kLinearDrag = PlanarPlace::linear_drag;
constexpr Index kQuadraticDrag = PlanarPlace::quadratic_drag;
constexpr Index kConstantForce = PlanarPlace::constant_force;

// Speeds of the thrusters at a time, and their slopes [1/s].
struct RowSpeeds {
  Eigen::VectorXd value;
  Eigen::VectorXd slope;
};

// The right-hand side with its derivatives.
class PathEquation {
 public:
  PathEquation(const Eigen::VectorXd& parameters, const std::vector<Index>& sought)
      : p_(parameters),
        sought_(sought),
        thrusters_((parameters.size() - PathPlace::count(0)) /
                   static_cast<Index>(PlanarPlace::per_thruster)),
        sway_inertia_(1.0 + p_(kMunk) * p_(kYawInertia)),
        by_parameter_(3, parameters.size()) {
    Eigen::Matrix3d mass = Eigen::Matrix3d::Identity();
    mass.bottomRightCorner<2, 2>() << sway_inertia_, p_(kSwayYawInertia), p_(kSwayYawInertia),
        p_(kYawInertia);
    inverse_ = mass.inverse();
    unit_ << 1.0, 1.0, mass(2, 2);
  }

  // Forces less those of inertia, as accelerations.
  Eigen::Vector3d acceleration(const PoseState& s, const Eigen::VectorXd& speeds) const {
    const auto [u, v, r] = std::array{s(3), s(4), s(5)};
    const double momentum = sway_inertia_ * v + p_(kSwayYawInertia) * r;
    const Eigen::Vector3d coriolis(r * momentum, -r * u, v * u - u * momentum);
    return inverse_ * (coriolis + unit_.cwiseProduct(applied(s, speeds)));
  }

  PoseState slope(const PoseState& s, const Eigen::VectorXd& speeds) const {
    const double cosine = std::cos(s(2));
    const double sine = std::sin(s(2));
    PoseState slope;
    slope << s(3) * cosine - s(4) * sine, s(3) * sine + s(4) * cosine, s(5),
        acceleration(s, speeds);
    slope.head<2>() += p_.tail<2>();
    return slope;
  }

  // d/dt of the derivatives S of a state: A S + B, with A = ∂f/∂s and B = ∂f/∂θ.
  StateSlopes slopes(const PoseState& s, const StateSlopes& slopes, const RowSpeeds& speeds) {
    StateSlopes result = by_state(s) * slopes;
    by_parameters(s, speeds);
    const Index current = PathPlace::current(thrusters_);
    for (std::size_t k = 0; k < sought_.size(); ++k) {
      const auto column = static_cast<Index>(k);
      if (sought_[k] < current) {
        result.col(column).tail<3>() += inverse_ * by_parameter_.col(sought_[k]);
      } else {
        result(sought_[k] - current, column) += 1.0;
      }
    }
    return result;
  }

 private:
  static double thrust(double speed, double ratio) {
    return (speed < 0.0 ? ratio : 1.0) * speed * std::abs(speed);
  }

  Eigen::Vector3d forward_force(Index at) const {
    return {p_(at + PathPlace::surge), p_(at + PathPlace::sway), p_(at + PathPlace::moment)};
  }

  // Forces of drag and thrusters, and the constant force, in the units of their parameters.
  Eigen::Vector3d applied(const PoseState& s, const Eigen::VectorXd& speeds) const {
    const Eigen::Array3d nu = s.tail<3>();
    Eigen::Vector3d force = p_.segment<3>(kConstantForce).array() -
                            p_.segment<3>(kLinearDrag).array() * nu -
                            p_.segment<3>(kQuadraticDrag).array() * nu.abs() * nu;
    for (Index i = 0; i < thrusters_; ++i) {
      const Index at = PathPlace::thruster(i);
      force += thrust(speeds(i), p_(at + PathPlace::ratio)) * forward_force(at);
    }
    return force;
  }

  Eigen::Matrix<double, 6, 6> by_state(const PoseState& s) const {
    const auto [u, v, r] = std::array{s(3), s(4), s(5)};
    const double cosine = std::cos(s(2));
    const double sine = std::sin(s(2));
    const double momentum = sway_inertia_ * v + p_(kSwayYawInertia) * r;
    Eigen::Matrix<double, 6, 6> a = Eigen::Matrix<double, 6, 6>::Zero();
    a.row(0) << 0.0, 0.0, -u * sine - v * cosine, cosine, -sine, 0.0;
    a.row(1) << 0.0, 0.0, u * cosine - v * sine, sine, cosine, 0.0;
    a(2, 5) = 1.0;
    Eigen::Matrix3d force;
    force << 0.0, r * sway_inertia_, momentum + r * p_(kSwayYawInertia),  //
        -r, 0.0, -u,                                                      //
        v - momentum, u - u * sway_inertia_, -u * p_(kSwayYawInertia);
    force.diagonal() -= unit_.cwiseProduct(
        p_.segment<3>(kLinearDrag) +
        2.0 * p_.segment<3>(kQuadraticDrag).cwiseProduct(s.tail<3>().cwiseAbs()));
    a.bottomRightCorner<3, 3>() = inverse_ * force;
    return a;
  }

  // Of the forces; M's parameters multiply the acceleration, too.
  void by_parameters(const PoseState& s, const RowSpeeds& at_row) {
    const Eigen::VectorXd& speeds = at_row.value;
    const Index shift = PathPlace::shift(thrusters_);
    const auto [u, v, r] = std::array{s(3), s(4), s(5)};
    const Eigen::Vector3d nu = s.tail<3>();
    const Eigen::Vector3d moved = acceleration(s, speeds);
    by_parameter_.setZero();
    const Eigen::Vector3d by_sway_inertia(r * v, -moved(1), -u * v);
    by_parameter_.col(kMunk) = p_(kYawInertia) * by_sway_inertia;
    by_parameter_.col(kYawInertia) = p_(kMunk) * by_sway_inertia;
    by_parameter_(2, kYawInertia) += applied(s, speeds)(2) - moved(2);
    by_parameter_.col(kSwayYawInertia) << r * r, -moved(2), -moved(1) - u * r;
    by_parameter_.middleCols<3>(kLinearDrag).diagonal() = -nu;
    by_parameter_.middleCols<3>(kQuadraticDrag).diagonal() = -nu.cwiseAbs().cwiseProduct(nu);
    by_parameter_.middleCols<3>(kConstantForce).diagonal().setOnes();
    for (Index i = 0; i < thrusters_; ++i) {
      const Index at = PathPlace::thruster(i);
      const double effect = thrust(speeds(i), p_(at + PathPlace::ratio));
      by_parameter_(0, at + PathPlace::surge) = effect;
      by_parameter_(1, at + PathPlace::sway) = effect;
      by_parameter_(2, at + PathPlace::moment) = effect;
      by_parameter_.col(at + PathPlace::ratio) =
          std::min(0.0, speeds(i)) * std::abs(speeds(i)) * forward_force(at);
      by_parameter_.col(shift) += 2.0 * std::abs(speeds(i)) * at_row.slope(i) *
                                  (speeds(i) < 0.0 ? p_(at + PathPlace::ratio) : 1.0) *
                                  forward_force(at);
    }
    by_parameter_(2, shift) *= unit_(2);
    by_parameter_.row(2).segment(kLinearDrag, PathPlace::munk(thrusters_) - kLinearDrag) *=
        unit_(2);
    by_parameter_(2, PathPlace::munk(thrusters_)) = -sway_inertia_ * u * v;
  }

  const Eigen::VectorXd& p_;
  const std::vector<Index>& sought_;
  Index thrusters_;
  double sway_inertia_;  // m22
  Eigen::Matrix3Xd by_parameter_;
  Eigen::Matrix3d inverse_;
  Eigen::Vector3d unit_;  // of forces: 1, 1, m33
};

// Speeds at a share of the step after a row; ramps `shift_s` later, and constant beyond the piece.
RowSpeeds speeds_at(const PathPiece& piece, Index row, double share, double shift_s,
                    BetweenRows between) {
  const double step_s = piece.times_s(row + 1) - piece.times_s(row);
  if (between != BetweenRows::ramps) {
    return {piece.speeds.col(between == BetweenRows::steps_after ? row : row + 1),
            Eigen::VectorXd::Zero(piece.speeds.rows())};
  }
  const auto last = static_cast<double>(piece.times_s.size() - 1);
  const double wanted = static_cast<double>(row) + share + shift_s / step_s;
  const double place = std::clamp(wanted, 0.0, last);
  const auto first = static_cast<Index>(std::min(std::floor(place), last - 1.0));
  const Eigen::VectorXd rise = piece.speeds.col(first + 1) - piece.speeds.col(first);
  return {piece.speeds.col(first) + (place - static_cast<double>(first)) * rise,
          place == wanted ? Eigen::VectorXd(rise / step_s)
                          : Eigen::VectorXd::Zero(piece.speeds.rows())};
}

// Runge-Kutta's step of order four, of the state and, if wanted, of its derivatives.
void advance(PathEquation& equation, const std::array<RowSpeeds, 3>& speeds, double h, PoseState& s,
             StateSlopes& by) {
  const auto& [begin, middle, end] = speeds;
  const PoseState k1 = equation.slope(s, begin.value);
  const PoseState s2 = s + 0.5 * h * k1;
  const PoseState k2 = equation.slope(s2, middle.value);
  const PoseState s3 = s + 0.5 * h * k2;
  const PoseState k3 = equation.slope(s3, middle.value);
  const PoseState s4 = s + h * k3;
  const PoseState k4 = equation.slope(s4, end.value);
  if (by.cols() > 0) {
    const StateSlopes b1 = equation.slopes(s, by, begin);
    const StateSlopes b2 = equation.slopes(s2, by + 0.5 * h * b1, middle);
    const StateSlopes b3 = equation.slopes(s3, by + 0.5 * h * b2, middle);
    const StateSlopes b4 = equation.slopes(s4, by + h * b3, end);
    by += h / 6.0 * (b1 + 2.0 * b2 + 2.0 * b3 + b4);
  }
  s += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
}

}  // namespace

PathStates drive_piece(const PathPiece& piece, const Eigen::VectorXd& parameters,
                       const PoseState& start, BetweenRows between,
                       const std::vector<Index>& sought, bool with_jacobian) {
  PathEquation equation(parameters, sought);
  const Index rows = piece.times_s.size();
  const Index columns = with_jacobian ? static_cast<Index>(sought.size()) + 6 : 0;
  PathStates path{.states = Eigen::MatrixXd(6, rows),
                  .jacobian = Eigen::MatrixXd(3 * rows, columns)};
  const double shift_s = parameters(PathPlace::shift(piece.speeds.rows()));
  PoseState s = start;
  StateSlopes by = StateSlopes::Zero(6, columns);
  if (with_jacobian) {
    by.rightCols<6>().setIdentity();
  }
  for (Index row = 0; row < rows; ++row) {
    path.states.col(row) = s;
    path.jacobian.middleRows<3>(3 * row) = by.topRows<3>();
    if (row + 1 == rows) {
      break;
    }
    const double step_s = piece.times_s(row + 1) - piece.times_s(row);
    const int steps =
        std::max(1, static_cast<int>(std::ceil(step_s / kPath.longest_step_s - 1e-6)));
    const double h = step_s / steps;
    for (int step = 0; step < steps; ++step) {
      const auto speeds = [&](double part) {
        return speeds_at(piece, row, (step + part) / steps, shift_s, between);
      };
      advance(equation, {speeds(0.0), speeds(0.5), speeds(1.0)}, h, s, by);
    }
  }
  return path;
}

Eigen::Vector3d path_acceleration(const Eigen::VectorXd& parameters, const PoseState& state,
                                  const Eigen::VectorXd& speeds) {
  return PathEquation(parameters, {}).acceleration(state, speeds);
}

}  // namespace kelpie
