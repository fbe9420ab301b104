// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "kelpie/motion/attitude.hpp"

namespace kelpie {

/// Form of a term of the inputs a and b.
enum class TermForm : std::uint8_t {
  one,         ///< 1
  linear,      ///< a
  magnitude,   ///< |a|
  square_law,  ///< a|a|
  square,      ///< a²
  product,     ///< a b
  cross_flow,  ///< a|b|
  lift,        ///< a b|b|
  ahead,       ///< max(a, 0)²
  astern,      ///< −min(a, 0)²
  // Components of the direction of gravity in the body (Fossen 2011, eq. 2.18); k is the unit.
  sine,           ///< sin(k a)
  cosine,         ///< cos(k a)
  cosine_sine,    ///< cos(k a) sin(l b)
  cosine_cosine,  ///< cos(k a) cos(l b)
  quaternion_x,   ///< 2 (a b − c d), of x, z, w, y
  quaternion_y,   ///< 2 (a b + c d), of y, z, w, x
  quaternion_z,   ///< 1 − 2 (a² + b²), of x, y
};

/// One term of an equation of motion.
struct MotionTerm {
  TermForm form = TermForm::one;
  std::size_t a = 0;  ///< an input; 0 for the term 1
  std::size_t b = 0;  ///< the second input of a form with two
  std::size_t c = 0;  ///< the third and the fourth of a quaternion
  std::size_t d = 0;
  double k = 1.0;  ///< unit of the angle a [rad]
  double l = 1.0;  ///< unit of the angle b [rad]

  bool operator==(const MotionTerm&) const = default;

  /// The value at the inputs x. Allocates nothing. The operations are those of text() as an
  /// Expression, so both give the same bits.
  double value(std::span<const double> x) const;

  /// The formula for Expression::parse(), for inputs of these names. The Expression has the
  /// derivative, the unit, and the steps that the C export writes.
  std::string text(std::span<const std::string> names) const;

  bool depends_on(std::size_t input) const;  ///< Whether `input` is in the formula.
  /// Whether the term damps the motion along the velocity `input`: a, |a|, a|a|, a², a|b|.
  bool damps(std::size_t input) const;
  int degree(std::size_t input) const;  ///< The power of a velocity in the term: 0, 1 or 2.
};

/// The terms of an equation of motion, in which accelerations are linear: the only list of them.
/// Velocities are some of the inputs, in the order of the accelerations; all other inputs but those
/// of an attitude are commands (speeds or forces of thrusters). Below, v is every velocity and n
/// every command. Restoring terms are the components of the direction of gravity in the body, as
/// far as the attitude is known: sin θ, cos θ sin φ, cos θ cos φ.
class MotionTerms {
 public:
  /// Without terms. `velocities`: places of inputs, each once and below `inputs`.
  MotionTerms(std::size_t inputs, std::span<const std::size_t> velocities,
              const Attitude& attitude = {});

  /// Every input.
  static MotionTerms linear(std::size_t inputs);
  /// x and x|x| of every v and n, the products of velocities, the restoring terms, then all other
  /// products. The first `velocities` inputs are velocities.
  static MotionTerms quadratic(std::size_t inputs, std::size_t velocities,
                               const Attitude& attitude = {});
  /// Fossen's equation: v, v|v|, products v w, v² (of the last velocity alone, or of all), drag
  /// v|w| of one velocity by another (`cross_flow`); of every n, max(n, 0)² and −min(n, 0)².
  static MotionTerms fossen(std::size_t inputs, std::span<const std::size_t> velocities,
                            bool all_squares, bool cross_flow, const Attitude& attitude = {});
  /// Of a model in open loop: fossen(), the restoring terms, then n, n v|v| of the first v (a
  /// rudder or a fin), n m|m| of up to three commands (a rudder behind a propeller), and n v of the
  /// first v (inflow). As far as there is room for `most` terms, all squares and cross flow are
  /// among the terms of fossen(), and n v of every v.
  static MotionTerms open_loop(std::size_t inputs, std::span<const std::size_t> velocities,
                               std::size_t most, const Attitude& attitude = {});
  /// Number of terms, the first ones, before the products of a command and a velocity.
  std::size_t without_inflow() const;
  /// For diagnosis: 1, v, |v|, v|v|, v², v w, v|w|, n, max(n, 0)², −min(n, 0)², the lift of fins
  /// and rudders as in open_loop(), restoring terms. Inputs of `others` have the terms n,
  /// max(n, 0)² and −min(n, 0)² of commands and are none.
  static MotionTerms diagnosis(std::size_t inputs, std::span<const std::size_t> velocities,
                               const Attitude& attitude = {},
                               std::span<const std::size_t> others = {});
  /// In the plane, the first inputs u, v, r: u, v, r, u|u|, v|v|, r|r|, vr, ur, r², uv, 1, then
  /// max(n, 0)² and −min(n, 0)² of every n.
  static MotionTerms planar(std::size_t thrusters);
  /// On six axes, the inputs u, v, w, p, q, r, three components of the direction of gravity, and
  /// thruster speeds n: v, v|v|, products and squares of velocities, the components, then
  /// max(n, 0)² and −min(n, 0)² of every n.
  static MotionTerms spatial(std::size_t thrusters);
  /// For the alignment of commands: v, v|v|, products v w, drag v|w|, n, n|n|, n of the first
  /// velocity (inflow), n|m| of up to three commands (a rudder behind a rotor), 1.
  static MotionTerms alignment(std::size_t inputs, std::span<const std::size_t> velocities);
  /// For the least-squares baseline: x and x|x| of every input, products and squares of the first
  /// `velocities` inputs.
  static MotionTerms baseline(std::size_t inputs, std::size_t velocities);

  std::size_t size() const { return terms_.size(); }
  const MotionTerm& operator[](std::size_t k) const { return terms_[k]; }
  /// Number of terms, the first ones, before the products with a command: of quadratic(); else all.
  std::size_t without_products() const { return std::min(without_products_, size()); }
  const std::vector<std::size_t>& velocities() const { return velocities_; }
  const std::vector<std::size_t>& commands() const { return commands_; }

  /// The values at x. Requires room for size() values. Allocates nothing.
  void evaluate(std::span<const double> x, std::span<double> values) const;

  /// MotionTerm::text() of every term.
  std::vector<std::string> texts(std::span<const std::string> names) const;

  /// The place of a term; size() for a missing term.
  std::size_t find(const MotionTerm& term) const;

 private:
  void add(TermForm form, std::size_t a = 0, std::size_t b = 0) { terms_.push_back({form, a, b}); }
  /// All forms of the first input, then of the next.
  void add_each(std::span<const std::size_t> inputs, std::initializer_list<TermForm> forms);
  void add_products(std::span<const std::size_t> inputs);  ///< Each pair once.
  void add_lift(std::size_t command);
  void add_restoring(const Attitude& attitude);

  std::vector<MotionTerm> terms_;
  std::size_t without_products_ = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> velocities_, commands_;
};

}  // namespace kelpie
