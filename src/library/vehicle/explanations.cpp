// SPDX-License-Identifier: Apache-2.0
#include "vehicle/explanations.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/eigen.hpp"
#include "kelpie/core/scaling.hpp"

namespace kelpie {
namespace {

using Form = TermForm;
using Directions = Eigen::Map<Eigen::MatrixXd>;
using Coefficients = Eigen::Map<const Eigen::MatrixXd>;

Eigen::Index at(std::size_t i) {
  return static_cast<Eigen::Index>(i);
}

// y = Θᵀφ with the thrust of one input taken away.
void thrust_direction(const MotionTerms& terms, const Coefficients& theta, std::size_t input,
                      Directions& out) {
  for (std::size_t k = 0; k < terms.size(); ++k) {
    if (terms[k].depends_on(input)) {
      out.row(at(k)) = -theta.row(at(k));
    }
  }
}

void drag_direction(const MotionTerms& terms, const Coefficients& theta, std::size_t axis,
                    Directions& out) {
  for (std::size_t k = 0; k < terms.size(); ++k) {
    if (terms[k].damps(terms.velocities()[axis])) {
      out(at(k), at(axis)) = theta(at(k), at(axis));
    }
  }
}

// What is shown is c times the velocity, and so is the acceleration that is made of it:
// φ(v) = c^-degree φ(shown). The derivative at c = 1.
void scale_direction(const MotionTerms& terms, const Coefficients& theta, std::size_t axis,
                     Directions& out) {
  for (std::size_t k = 0; k < terms.size(); ++k) {
    out.row(at(k)) = -terms[k].degree(terms.velocities()[axis]) * theta.row(at(k));
  }
  out.col(at(axis)) += theta.col(at(axis));
}

// The derivative of Θᵀφ by a velocity, as far as it is made of terms; towards smaller velocities.
void bias_direction(const MotionTerms& terms, const Coefficients& theta, std::size_t axis,
                    Directions& out) {
  const std::size_t input = terms.velocities()[axis];
  const auto add = [&](std::size_t k, Form form, std::size_t other, double factor) {
    const std::size_t to = terms.find({form, other});
    out.row(at(to)) -= factor * theta.row(at(k));
  };
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const MotionTerm& term = terms[k];
    if (term.form == Form::product && (term.a == input || term.b == input)) {
      add(k, Form::linear, term.a == input ? term.b : term.a, 1.0);
    } else if (term.a != input) {
      continue;
    } else if (term.form == Form::linear) {
      add(k, Form::one, 0, 1.0);
    } else if (term.form == Form::square_law) {
      add(k, Form::magnitude, input, 2.0);
    } else if (term.form == Form::square) {
      add(k, Form::linear, input, 2.0);
    } else if (term.form == Form::cross_flow) {
      add(k, Form::magnitude, term.b, 1.0);
    }
  }
}

}  // namespace

Explanations::Explanations(const MotionTerms& terms, std::vector<std::size_t> body_axes)
    : body_axes_(std::move(body_axes)) {
  const std::size_t axes = terms.velocities().size();
  for (const std::size_t input : terms.commands()) {
    list_.push_back({CauseKind::thruster, input, {column(CauseKind::thruster, input)}});
  }
  for (std::size_t axis = 0; axis < axes; ++axis) {
    list_.push_back({CauseKind::drag, axis, {column(CauseKind::drag, axis)}});
  }
  add_loads();
  std::vector<std::size_t> forces;
  for (std::size_t axis = 0; axis < axes; ++axis) {
    forces.push_back(column(CauseKind::force, axis));
    list_.push_back({CauseKind::force, axis, {forces.back()}});
  }
  for (std::size_t axis = 0; axes > 1 && axis < axes; ++axis) {
    list_.push_back({CauseKind::force, axis, forces});
    std::swap(list_.back().columns[0], list_.back().columns[axis]);
  }
  for (const CauseKind kind : {CauseKind::sensor_scale, CauseKind::sensor_bias}) {
    for (std::size_t axis = 0; axis < axes; ++axis) {
      list_.push_back({kind, terms.velocities()[axis], {column(kind, axis)}});
    }
  }
  if (terms.commands().size() > 1) {
    list_.push_back({CauseKind::all_thrusters, 0, {column(CauseKind::all_thrusters, 0)}});
  }
}

std::size_t Explanations::column(CauseKind kind, std::size_t place, std::size_t from) {
  columns_.push_back({kind, place, from});
  return columns_.size() - 1;
}

std::vector<std::size_t> Explanations::health_columns() const {
  std::vector<std::size_t> found;
  std::vector<std::size_t> forces;
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    if (columns_[c].kind == CauseKind::thruster) {
      found.push_back(c);
    } else if (columns_[c].kind == CauseKind::force) {
      forces.push_back(c);
    }
  }
  found.resize(std::min(found.size(), kMostColumns - forces.size()));
  found.insert(found.end(), forces.begin(), forces.end());
  return found;
}

// A load adds to the inertia along every axis, by as much as it likes; without a known axis of
// translation it is left out.
void Explanations::add_loads() {
  Explanation load{CauseKind::load, 0, {}};
  for (std::size_t axis = 0; axis < body_axes_.size(); ++axis) {
    if (body_axes_[axis] < 3) {
      load.columns.push_back(column(CauseKind::load, axis, axis));
    }
  }
  if (load.columns.empty()) {
    return;
  }
  list_.push_back(load);
  if (body_axes_ == std::vector<std::size_t>{0, 1, 5}) {
    // Off the centre it adds to yaw as well, and couples yaw to both others.
    for (const auto& [on, from] : std::span(kLoadColumns).subspan(load.columns.size())) {
      load.columns.push_back(column(CauseKind::load, on, from));
    }
    list_.push_back(std::move(load));
  }
}

// The acceleration of an axis as an observer at rest sees it, v̇ + ω × v: what inertia resists.
void Explanations::inertial(const MotionTerms& terms, std::size_t axis,
                            std::span<double> direction) const {
  const std::size_t along = body_axes_[axis];
  if (along >= 3) {
    return;
  }
  const auto state_of = [&](std::size_t body) {
    const auto found = std::ranges::find(body_axes_, body);
    return found == body_axes_.end()
               ? terms.size()
               : terms.velocities()[static_cast<std::size_t>(found - body_axes_.begin())];
  };
  for (const auto& [turn, move, sign] : {std::tuple{(along + 1) % 3, (along + 2) % 3, 1.0},
                                         std::tuple{(along + 2) % 3, (along + 1) % 3, -1.0}}) {
    const std::size_t rate = state_of(3 + turn);
    const std::size_t velocity = state_of(move);
    const std::size_t k = std::min(terms.find({Form::product, rate, velocity}),
                                   terms.find({Form::product, velocity, rate}));
    if (k < terms.size()) {
      direction[k] += sign;
    }
  }
}

// A share of the acceleration of one axis is added to another; or the pull of a load that is
// carried around in turns, r².
void Explanations::load_direction(const MotionTerms& terms, std::span<const double> theta,
                                  const Column& column, std::span<double> out) const {
  const std::span<double> on = out.subspan(column.place * terms.size(), terms.size());
  if (column.from == LoadColumn::kTurning) {
    on[terms.find({Form::square, terms.velocities()[2]})] = 1.0;
    return;
  }
  std::ranges::copy(theta.subspan(column.from * terms.size(), terms.size()), on.begin());
  inertial(terms, column.from, on);
}

void Explanations::directions(const MotionTerms& terms, std::span<const double> theta,
                              std::span<const double> thrust, std::span<double> directions) const {
  const Coefficients coefficients = columns_of(theta, terms.size());
  const Coefficients thrusts = columns_of(thrust, terms.size());
  std::ranges::fill(directions, 0.0);
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const std::span<double> place = directions.subspan(c * theta.size(), theta.size());
    Directions out = columns_of(place, terms.size());
    const std::size_t where = columns_[c].place;
    switch (columns_[c].kind) {
      case CauseKind::thruster:
        thrust_direction(terms, thrusts, where, out);
        break;
      case CauseKind::all_thrusters:
        for (const std::size_t input : terms.commands()) {
          thrust_direction(terms, thrusts, input, out);
        }
        break;
      case CauseKind::drag:
        drag_direction(terms, coefficients, where, out);
        break;
      case CauseKind::load:
        load_direction(terms, theta, columns_[c], place);
        break;
      case CauseKind::force:
        out(at(terms.find({Form::one})), at(where)) = 1.0;
        break;
      case CauseKind::sensor_scale:
        scale_direction(terms, coefficients, where, out);
        break;
      case CauseKind::sensor_bias:
        bias_direction(terms, coefficients, where, out);
        break;
      case CauseKind::frozen:
        break;
    }
  }
}

// φ(v) = c^-degree φ(shown), and the axis' own acceleration is shown c times as large; c = 1 + s.
bool Explanations::curve(const MotionTerms& terms, std::size_t explanation,
                         std::span<const double> theta, double s, std::span<double> delta,
                         std::span<double> tangent) const {
  if (list_[explanation].kind != CauseKind::sensor_scale) {
    return false;
  }
  const std::size_t axis = columns_[list_[explanation].columns[0]].place;
  const double c = std::max(1.0 + s, 0.05);
  for (std::size_t i = 0; i < theta.size(); ++i) {
    const bool own = i / terms.size() == axis;
    const int power = (own ? 1 : 0) - terms[i % terms.size()].degree(terms.velocities()[axis]);
    delta[i] = theta[i] * (std::pow(c, power) - 1.0);
    tangent[i] = theta[i] * power * std::pow(c, power - 1);
  }
  return true;
}

Cause Explanations::cause(std::size_t explanation, double s, double reach) const {
  const Explanation& of = list_[explanation];
  const auto told = [&](auto size_of) {
    const double one = size_of(s - reach);
    const double other = size_of(s + reach);
    return Cause{of.kind, of.place, size_of(s), std::min(one, other), std::max(one, other)};
  };
  switch (of.kind) {
    case CauseKind::thruster:
    case CauseKind::all_thrusters:
      return told([](double size) { return 1.0 - size; });
    case CauseKind::load:
      return told([](double size) { return 1.0 / std::max(1.0 + size, 1e-3); });
    case CauseKind::drag:
    case CauseKind::sensor_scale:
      return told([](double size) { return 1.0 + size; });
    default:
      return told([](double size) { return size; });
  }
}

void visit_cause(Archive& archive, Cause& cause) {
  archive.choice(cause.kind, CauseKind::thruster, CauseKind::all_thrusters);
  archive.whole(cause.place, 0, kMostInputs - 1);
  for (double* const number : {&cause.size, &cause.lower, &cause.upper}) {
    archive.any_number(*number);
  }
}

}  // namespace kelpie
