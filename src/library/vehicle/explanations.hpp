// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/quantile.hpp"
#include "kelpie/core/archive.hpp"
#include "kelpie/vehicle/diagnosis.hpp"
#include "motion/motion_terms.hpp"

namespace kelpie {

inline constexpr std::size_t kMostColumns = 24;  ///< of one Agreement

/// The columns of a load, in their order: the first axis takes a share of the acceleration of the
/// second axis, kTurning: of r². All nine are of a load off the centre of surge, sway and yaw.
struct LoadColumn {
  static constexpr std::size_t kTurning = 6;
  std::size_t on;
  std::size_t from;
};
inline constexpr std::array<LoadColumn, 9> kLoadColumns{{{0, 0},
                                                         {1, 1},
                                                         {2, 2},
                                                         {1, 2},
                                                         {2, 1},
                                                         {0, 2},
                                                         {2, 0},
                                                         {0, LoadColumn::kTurning},
                                                         {1, LoadColumn::kTurning}}};

/// The effect of a cause on the coefficients Θ (terms × axes) of the equations of motion: one
/// direction per column, ΔΘ = Σ s_c D_c(Θ).
struct Explanation {
  CauseKind kind = CauseKind::thruster;
  std::size_t place = 0;             ///< as Cause::place
  std::vector<std::size_t> columns;  ///< the size along the first column is the size of the cause
};

/// The explanations of every single cause: each thruster, the drag of each axis, a load, a force on
/// each axis and on all axes, scale and bias of each velocity; last, of two thrusters or more, all
/// thrusters by one factor. Derived from the terms alone, so the same for any vehicle.
class Explanations {
 public:
  /// `body_axes`: 0 to 5 for u, v, w, p, q, r, for each state; another number: unknown.
  Explanations(const MotionTerms& terms, std::vector<std::size_t> body_axes);

  std::span<const Explanation> list() const { return list_; }
  std::size_t columns() const { return columns_.size(); }  ///< of all explanations together

  /// The columns of thrusters in their order, as many as there is room for in an Agreement, then of
  /// a force on each axis.
  std::vector<std::size_t> health_columns() const;

  /// The directions D_c in the order of the columns, at the coefficients `theta` (terms × axes); of
  /// the thrusters, at the coefficients `thrust`. Requires room for columns() · theta.size()
  /// values. Allocates nothing.
  void directions(const MotionTerms& terms, std::span<const double> theta,
                  std::span<const double> thrust, std::span<double> directions) const;

  /// For an explanation with a nonlinear effect (the scale of a sensor): the change at the size s
  /// and its derivative, both shaped like `theta`. Returns false, and writes nothing, otherwise.
  bool curve(const MotionTerms& terms, std::size_t explanation, std::span<const double> theta,
             double s, std::span<double> delta, std::span<double> tangent) const;

  /// The cause for the size s ± `reach` along the first column.
  Cause cause(std::size_t explanation, double s, double reach) const;

 private:
  struct Column {
    CauseKind kind;
    std::size_t place;     // as Cause::place; for a load: the axis that is accelerated
    std::size_t from = 0;  // for a load: as LoadColumn::from
  };
  std::size_t column(CauseKind kind, std::size_t place, std::size_t from = 0);
  void add_loads();
  void inertial(const MotionTerms& terms, std::size_t axis, std::span<double> direction) const;
  void load_direction(const MotionTerms& terms, std::span<const double> theta, const Column& column,
                      std::span<double> out) const;

  std::vector<std::size_t> body_axes_;
  std::vector<Column> columns_;
  std::vector<Explanation> list_;
};

void visit_cause(Archive& archive, Cause& cause);  ///< core/archive.hpp

}  // namespace kelpie
