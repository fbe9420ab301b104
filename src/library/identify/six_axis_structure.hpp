// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/decomposition.hpp"
#include "identify/minimum_distance.hpp"
#include "identify/six_axis_fit.hpp"
#include "motion/motion_terms.hpp"

namespace kelpie {

/// An index of the standard library as one of Eigen.
constexpr Eigen::Index place_of(std::size_t place) {
  return static_cast<Eigen::Index>(place);
}

/// Force and moment per newton of each thruster about the origin, 6 × thrusters.
Eigen::MatrixXd thruster_arms(std::span<const PlacedThruster> thrusters);

/// Fossen's equation on six axes: the residual M Bᵀ − Θ(θ) is linear in θ (SixAxisPlace). The terms
/// are those of MotionTerms::spatial(), then six per parameter of the thrust curve: derivatives of
/// the thrusters' forces by the parameter.
class SixAxisStructure {
 public:
  explicit SixAxisStructure(std::span<const PlacedThruster> thrusters);

  const MotionTerms& terms() const { return terms_; }
  Eigen::Index parameters() const { return parameters_; }

  Eigen::MatrixXd mass(const Eigen::VectorXd& parameters) const;
  /// Θ(θ), 6 × terms. `count`: terms in use, with or without those of the curve.
  Eigen::MatrixXd forces(const Eigen::VectorXd& parameters, Eigen::Index count) const;
  StructureResidual residual(const Eigen::MatrixXd& coefficients,
                             const Eigen::VectorXd& parameters) const;
  /// For minimise_distance(): this object has to outlive the result.
  EquationStructure equation() const;

 private:
  struct Entry {
    Eigen::Index row = 0;     // axis
    Eigen::Index column = 0;  // term, or axis of M
    Eigen::Index parameter = 0;
    double factor = 0.0;
  };

  void add_force(Eigen::Index axis, std::size_t term, std::size_t parameter, double factor);
  void add_inertia(std::size_t row, std::size_t column, std::size_t parameter, double factor);
  void add_coriolis(std::size_t row, std::size_t column, std::size_t parameter, double factor);
  std::size_t product(std::size_t a, std::size_t b) const;

  MotionTerms terms_;
  Eigen::Index parameters_;
  std::vector<Entry> inertias_;
  std::vector<Entry> forces_;
};

/// The vehicle of a fit, for many calls of SixAxisFit::acceleration().
class SixAxisVehicle {
 public:
  explicit SixAxisVehicle(const SixAxisFit& fit);

  /// Requirements as of SixAxisFit::acceleration(). Allocates.
  SixVector acceleration(std::span<const double, kSixAxes> velocity,
                         std::span<const double, 3> down, std::span<const double> speeds) const;

 private:
  MotionTerms terms_;
  Eigen::MatrixXd forces_;  ///< Θ
  std::optional<PivotedFactor> mass_;
};

}  // namespace kelpie
