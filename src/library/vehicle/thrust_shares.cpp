// SPDX-License-Identifier: Apache-2.0
#include "vehicle/thrust_shares.hpp"

#include <algorithm>
#include <cmath>

#include "core/eigen.hpp"
#include "vehicle/tuning.hpp"

namespace kelpie {
namespace {

// Whether a change of the coefficients changes one of thrust.
bool moves_thrust(const MotionTerms& terms, std::span<const double> delta) {
  const auto change = columns_of(delta, terms.size());
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const bool is_thrust = std::ranges::any_of(
        terms.commands(), [&](std::size_t input) { return terms[k].depends_on(input); });
    if (is_thrust && !change.row(static_cast<Eigen::Index>(k)).isZero(0.0)) {
      return true;
    }
  }
  return false;
}

// Such a thruster gives many times its last thrust when it comes back.
bool is_dead(const Cause& thruster) {
  return thruster.size < kDiagnosis.dead_share;
}

// The share of a thruster that gives `factor` times its thrust of before.
Cause product_of(const Cause& before, const Cause& factor) {
  const double half = std::hypot(0.5 * (factor.upper - factor.lower) * before.size,
                                 0.5 * (before.upper - before.lower) * factor.size);
  const double size = before.size * factor.size;
  return {before.kind, before.place, size, size - half, size + half};
}

}  // namespace

ThrustShares::ThrustShares(const MotionTerms& terms, std::size_t axes)
    : most_(terms.size() * axes) {
  for (const std::size_t command : terms.commands()) {
    present_.push_back({CauseKind::thruster, command, 1.0, 1.0, 1.0});
  }
  settled_ = present_;
  nominal_.reserve(most_);
}

double ThrustShares::settled(std::size_t input) const {
  return std::ranges::find(settled_, input, &Cause::place)->size;
}

Cause ThrustShares::against_nominal(const Cause& cause, const CoefficientMonitor& monitor) const {
  if (cause.kind != CauseKind::thruster) {
    return cause;
  }
  const Cause& before = *std::ranges::find(settled_, cause.place, &Cause::place);
  if (is_dead(before)) {
    const double last = projected(cause.place, monitor) - 1.0;
    return {cause.kind, cause.place, last + cause.size, last + cause.lower, last + cause.upper};
  }
  return product_of(before, cause);
}

void ThrustShares::dead_thrust(const MotionTerms& terms, std::span<double> thrust) const {
  std::ranges::fill(thrust, 0.0);
  if (nominal_.empty()) {
    return;
  }
  auto rows = columns_of(thrust, terms.size());
  for (const Cause& thruster : settled_) {
    for (std::size_t k = 0; is_dead(thruster) && k < terms.size(); ++k) {
      if (terms[k].depends_on(thruster.place)) {
        const auto row = static_cast<Eigen::Index>(k);
        rows.row(row) = columns_of(std::span<const double>(nominal_), terms.size()).row(row);
      }
    }
  }
}

void ThrustShares::follow(std::span<const Cause> changed) {
  present_ = settled_;
  for (const Cause& cause : changed) {
    for (Cause& thruster : present_) {
      if (cause.kind == CauseKind::all_thrusters) {
        thruster = product_of(thruster, cause);
      } else if (cause.kind == CauseKind::thruster && cause.place == thruster.place) {
        thruster = cause;
      }
    }
  }
}

void ThrustShares::settle(const MotionTerms& terms, std::span<const double> theta,
                          std::span<const double> delta) {
  settled_ = present_;
  if (nominal_.empty() && (delta.empty() || moves_thrust(terms, delta))) {
    nominal_.assign(theta.begin(), theta.end());
  }
}

// Of a thruster in the reference: the projection on its nominal thrust, terms weighted by their
// size in the reference.
double ThrustShares::projected(std::size_t input, const CoefficientMonitor& monitor) const {
  const MotionTerms& terms = monitor.terms();
  const auto before = columns_of(nominal(monitor.fit().theta()), terms.size());
  const auto theta = columns_of(monitor.fit().theta(), terms.size());
  const auto precision =
      columns_of(monitor.fit().precision(), static_cast<std::size_t>(theta.cols()));
  const auto gram = monitor.reference().gram();
  double along = 0.0;
  double square = 0.0;
  for (Eigen::Index k = 0; k < theta.rows(); ++k) {
    for (Eigen::Index axis = 0;
         terms[static_cast<std::size_t>(k)].depends_on(input) && axis < theta.cols(); ++axis) {
      const double weighted = gram(k, k) * precision(axis, axis) * before(k, axis);
      along += weighted * theta(k, axis);
      square += weighted * before(k, axis);
    }
  }
  return square > 0.0 ? along / square : 1.0;
}

std::span<const double> ThrustShares::nominal(std::span<const double> theta) const {
  return nominal_.empty() ? theta : std::span<const double>(nominal_);
}

Eigen::MatrixXd ThrustShares::coefficients(const MotionTerms& terms,
                                           std::span<const double> theta) const {
  const auto before = columns_of(nominal(theta), terms.size());
  Eigen::MatrixXd now = columns_of(theta, terms.size());
  for (std::size_t k = 0; k < terms.size(); ++k) {
    for (const Cause& thruster : present_) {
      if (terms[k].depends_on(thruster.place)) {
        const auto row = static_cast<Eigen::Index>(k);
        now.row(row) = thruster.size * before.row(row);
      }
    }
  }
  return now;
}

void ThrustShares::visit(Archive& archive) {
  for (std::vector<Cause>* const shares : {&present_, &settled_}) {
    for (Cause& thruster : *shares) {
      const std::size_t place = thruster.place;
      visit_cause(archive, thruster);
      archive.require(thruster.place == place, "the share of another thruster");
    }
  }
  archive.list(nominal_, most_, [&](double& number) { archive.number(number); });
  archive.require(nominal_.empty() || nominal_.size() == most_, "another number of coefficients");
}

}  // namespace kelpie
