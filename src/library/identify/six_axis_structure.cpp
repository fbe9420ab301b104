// SPDX-License-Identifier: Apache-2.0
#include "identify/six_axis_structure.hpp"

#include <algorithm>

namespace kelpie {
namespace {

constexpr std::size_t kDown = 6;  // first place of the direction of gravity among the inputs

// ε of the vector product: (a × b)_c = Σ ε(c, i, j) a_i b_j.
double permutation(std::size_t c, std::size_t i, std::size_t j) {
  if (c == i || i == j || c == j) {
    return 0.0;
  }
  return (i + 3 - c) % 3 == 1 ? 1.0 : -1.0;
}

}  // namespace

Eigen::MatrixXd thruster_arms(std::span<const PlacedThruster> thrusters) {
  Eigen::MatrixXd arms(6, place_of(thrusters.size()));
  for (std::size_t i = 0; i < thrusters.size(); ++i) {
    const Triple& d = thrusters[i].direction;
    const Triple& p = thrusters[i].position_m;
    arms.col(place_of(i)) << d[0], d[1], d[2], p[1] * d[2] - p[2] * d[1], p[2] * d[0] - p[0] * d[2],
        p[0] * d[1] - p[1] * d[0];
  }
  return arms;
}

SixAxisStructure::SixAxisStructure(std::span<const PlacedThruster> thrusters)
    : terms_(MotionTerms::spatial(thrusters.size())),
      parameters_(place_of(SixAxisPlace::curve(thrusters.size()) + SixAxisPlace::curve_size)) {
  for (std::size_t axis = 0; axis < kSixAxes; ++axis) {
    add_inertia(axis, axis, SixAxisPlace::inertia + axis, 1.0);
    add_force(place_of(axis), terms_.find({.form = TermForm::linear, .a = axis}),
              SixAxisPlace::linear_drag + axis, -1.0);
    add_force(place_of(axis), terms_.find({.form = TermForm::square_law, .a = axis}),
              SixAxisPlace::quadratic_drag + axis, -1.0);
  }
  for (const auto& [row, column, factor] : {std::tuple{0U, 4U, 1.0}, std::tuple{4U, 0U, 1.0},
                                            std::tuple{1U, 3U, -1.0}, std::tuple{3U, 1U, -1.0}}) {
    add_inertia(row, column, SixAxisPlace::low_centre, factor);
  }
  for (const auto& [row, column, factor] : {std::tuple{1U, 5U, 1.0}, std::tuple{5U, 1U, 1.0},
                                            std::tuple{2U, 4U, -1.0}, std::tuple{4U, 2U, -1.0}}) {
    add_inertia(row, column, SixAxisPlace::forward_centre, factor);
  }
  for (std::size_t c = 0; c < 3; ++c) {
    add_force(place_of(c), terms_.find({.form = TermForm::linear, .a = kDown + c}),
              SixAxisPlace::net_weight, 1.0);
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b < 3; ++b) {
        add_force(place_of(3 + c), terms_.find({.form = TermForm::linear, .a = kDown + b}),
                  SixAxisPlace::moment + a, permutation(c, a, b));
      }
    }
  }
  const Eigen::MatrixXd arms = thruster_arms(thrusters);
  for (std::size_t i = 0; i < thrusters.size(); ++i) {
    const std::size_t input = kDown + 3 + i;
    for (Eigen::Index axis = 0; axis < 6; ++axis) {
      add_force(axis, terms_.find({.form = TermForm::ahead, .a = input}), SixAxisPlace::thruster(i),
                arms(axis, place_of(i)));
      add_force(axis, terms_.find({.form = TermForm::astern, .a = input}),
                SixAxisPlace::thruster(i) + 1, arms(axis, place_of(i)));
    }
  }
  for (std::size_t k = 0; k < SixAxisPlace::curve_size; ++k) {
    for (std::size_t axis = 0; axis < kSixAxes; ++axis) {
      add_force(place_of(axis), terms_.size() + kSixAxes * k + axis,
                SixAxisPlace::curve(thrusters.size()) + k, 1.0);
    }
  }
}

void SixAxisStructure::add_force(Eigen::Index axis, std::size_t term, std::size_t parameter,
                                 double factor) {
  if (factor != 0.0) {
    forces_.push_back({axis, place_of(term), place_of(parameter), factor});
  }
}

void SixAxisStructure::add_inertia(std::size_t row, std::size_t column, std::size_t parameter,
                                   double factor) {
  inertias_.push_back({place_of(row), place_of(column), place_of(parameter), factor});
  add_coriolis(row, column, parameter, factor);
}

std::size_t SixAxisStructure::product(std::size_t a, std::size_t b) const {
  return a == b
             ? terms_.find({.form = TermForm::square, .a = a})
             : terms_.find({.form = TermForm::product, .a = std::min(a, b), .b = std::max(a, b)});
}

// The momentum M ν has factor · ν_column in the place `row`: −C ν = −[ω × p; v × p + ω × h].
void SixAxisStructure::add_coriolis(std::size_t row, std::size_t column, std::size_t parameter,
                                    double factor) {
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t a = 0; a < 3; ++a) {
      const double sign = -factor * permutation(c, a, row % 3);
      if (row < 3) {
        add_force(place_of(c), product(3 + a, column), parameter, sign);
        add_force(place_of(3 + c), product(a, column), parameter, sign);
      } else {
        add_force(place_of(3 + c), product(3 + a, column), parameter, sign);
      }
    }
  }
}

Eigen::MatrixXd SixAxisStructure::mass(const Eigen::VectorXd& parameters) const {
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(6, 6);
  for (const Entry& entry : inertias_) {
    mass(entry.row, entry.column) += entry.factor * parameters(entry.parameter);
  }
  return mass;
}

Eigen::MatrixXd SixAxisStructure::forces(const Eigen::VectorXd& parameters,
                                         Eigen::Index count) const {
  Eigen::MatrixXd forces = Eigen::MatrixXd::Zero(6, count);
  for (const Entry& entry : forces_) {
    if (entry.column < count) {
      forces(entry.row, entry.column) += entry.factor * parameters(entry.parameter);
    }
  }
  return forces;
}

StructureResidual SixAxisStructure::residual(const Eigen::MatrixXd& coefficients,
                                             const Eigen::VectorXd& parameters) const {
  const Eigen::Index count = coefficients.rows();
  StructureResidual residual{Eigen::VectorXd(6 * count),
                             Eigen::MatrixXd::Zero(6 * count, parameters.size())};
  for (Eigen::Index term = 0; term < count; ++term) {
    for (const Entry& entry : inertias_) {
      residual.jacobian(6 * term + entry.row, entry.parameter) +=
          entry.factor * coefficients(term, entry.column);
    }
  }
  for (const Entry& entry : forces_) {
    if (entry.column < count) {
      residual.jacobian(6 * entry.column + entry.row, entry.parameter) -= entry.factor;
    }
  }
  residual.value = residual.jacobian * parameters;
  return residual;
}

EquationStructure SixAxisStructure::equation() const {
  EquationStructure structure{
      .residual =
          [this](const Eigen::MatrixXd& coefficients, const Eigen::VectorXd& parameters) {
            return residual(coefficients, parameters);
          },
      .mass = [this](const Eigen::VectorXd& parameters) { return mass(parameters); }};
  const Eigen::Index curve = parameters_ - place_of(SixAxisPlace::curve_size);
  for (Eigen::Index place = 0; place < curve; ++place) {
    const auto at = static_cast<std::size_t>(place);
    const bool is_inertia = at < SixAxisPlace::low_centre;
    const bool is_drag = at >= SixAxisPlace::linear_drag && at < SixAxisPlace::net_weight;
    if (is_inertia || is_drag || at >= SixAxisPlace::thrusters) {
      structure.positive.push_back(place);
    }
  }
  return structure;
}

}  // namespace kelpie
