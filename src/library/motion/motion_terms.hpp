// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

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
  ahead,       ///< max(a, 0)²
  astern,      ///< −min(a, 0)²
};

/// One term of an equation of motion.
struct MotionTerm {
  TermForm form = TermForm::one;
  std::size_t a = 0;  ///< an input; 0 for the term 1
  std::size_t b = 0;  ///< the second input of a product or a cross flow

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
/// Velocities are some of the inputs, in the order of the accelerations; all other inputs are
/// commands (speeds or forces of thrusters). Below, v is every velocity and n every command.
class MotionTerms {
 public:
  /// Without terms. `velocities`: places of inputs, each once and below `inputs`.
  MotionTerms(std::size_t inputs, std::span<const std::size_t> velocities);

  /// Every input.
  static MotionTerms linear(std::size_t inputs);
  /// x and x|x| of every input, the products of velocities, then all other products.
  static MotionTerms quadratic(std::size_t inputs, std::size_t velocities);
  /// Fossen's equation: v, v|v|, products v w, v² (of the last velocity alone, or of all), drag
  /// v|w| of one velocity by another (`cross_flow`); of every n, max(n, 0)² and −min(n, 0)².
  static MotionTerms fossen(std::size_t inputs, std::span<const std::size_t> velocities,
                            bool all_squares, bool cross_flow);
  /// fossen() with all squares and cross flow, then n v of every pair.
  static MotionTerms open_loop(std::size_t inputs, std::span<const std::size_t> velocities);
  /// For diagnosis: 1, v, |v|, v|v|, v², v w, v|w|, n, max(n, 0)², −min(n, 0)².
  static MotionTerms diagnosis(std::size_t inputs, std::span<const std::size_t> velocities);
  /// In the plane, the first inputs u, v, r: u, v, r, u|u|, v|v|, r|r|, vr, ur, r², uv, 1, then
  /// max(n, 0)² and −min(n, 0)² of every n.
  static MotionTerms planar(std::size_t thrusters);
  /// For the alignment of commands: v, v|v|, products v w, drag v|w|, n, n|n|, n of the first
  /// velocity (inflow), n|m| of up to three commands (a rudder behind a rotor), 1.
  static MotionTerms alignment(std::size_t inputs, std::span<const std::size_t> velocities);
  /// For the least-squares baseline: x and x|x| of every input, products and squares of the first
  /// `velocities` inputs.
  static MotionTerms baseline(std::size_t inputs, std::size_t velocities);

  std::size_t size() const { return terms_.size(); }
  const MotionTerm& operator[](std::size_t k) const { return terms_[k]; }
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

  std::vector<MotionTerm> terms_;
  std::vector<std::size_t> velocities_, commands_;
};

}  // namespace kelpie
