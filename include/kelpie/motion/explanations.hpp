// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "kelpie/motion/basis.hpp"
#include "kelpie/motion/cause.hpp"

namespace kelpie {

inline constexpr std::size_t kMostColumns = 24;  ///< that are compared at a time

/// A cause as it changes the coefficients Θ (terms × axes) of the equations of motion: along one
/// direction for each of its columns, ΔΘ = Σ s_c D_c(Θ).
struct Explanation {
  CauseKind kind = CauseKind::thruster;  ///< as Cause::kind
  std::size_t place = 0;                 ///< as Cause::place
  std::vector<std::size_t> columns;      ///< its size is that of the first
};

/// Every single cause that can be told of a vehicle: each thruster, the drag of each axis, a load,
/// a force on each axis and on all of them, scale and bias of each velocity. Written down from what
/// a term belongs to, once, and the same for any vehicle.
class Explanations {
 public:
  /// `body_axes`: 0 to 5 for u, v, w, p, q, r, one per state; another number: not known.
  Explanations(const Basis& basis, std::vector<std::size_t> body_axes);

  std::span<const Explanation> list() const { return list_; }  ///< One after the other.
  std::size_t columns() const { return columns_.size(); }      ///< Of all explanations together.

  /// The columns of all thrusters in their order, then those of a force on each axis.
  std::vector<std::size_t> health_columns() const;

  /// The directions D_c, one after the other, at the coefficients `theta` (terms × axes). Requires
  /// room for columns() · theta.size() values. Allocates nothing.
  void directions(const Basis& basis, std::span<const double> theta,
                  std::span<double> directions) const;

  /// Of an explanation whose change isn't straight (a sensor's scale) the change at the size s, and
  /// its derivative there; false, and nothing is written, of all others. Both as `theta`.
  bool curve(const Basis& basis, std::size_t explanation, std::span<const double> theta, double s,
             std::span<double> delta, std::span<double> tangent) const;

  /// The cause whose first column has the size s ± `reach`.
  Cause cause(std::size_t explanation, double s, double reach) const;

 private:
  struct Column {
    CauseKind kind;
    std::size_t place;     // of CauseKind; of a load the axis that it acts on …
    std::size_t from = 0;  // … by the acceleration of this one, or kTurning
  };
  static constexpr std::size_t kTurning = 6;
  std::size_t column(CauseKind kind, std::size_t place, std::size_t from = 0);
  void add_loads();
  void inertial(const Basis& basis, std::size_t axis, std::span<double> direction) const;
  void load_direction(const Basis& basis, std::span<const double> theta, const Column& column,
                      std::span<double> out) const;

  std::vector<std::size_t> body_axes_;
  std::vector<Column> columns_;
  std::vector<Explanation> list_;
};

}  // namespace kelpie
