// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kelpie/core/scaling.hpp"
#include "kelpie/motion/attitude.hpp"
#include "kelpie/motion/expression.hpp"

namespace kelpie {

/// The physics terms φ(x) of a model: formulas over the raw inputs, in which the equations of
/// motion are linear. Each term is divided by its own scale, so weights of terms are comparable.
class TermSet {
 public:
  static constexpr std::string_view kAuto = "auto";
  static constexpr std::string_view kAutoDegrees = "auto:degrees";

  TermSet() = default;  ///< no terms

  /// Reads a specification:
  ///
  ///     none
  ///     auto          quadratic; of roll and pitch, or of a quaternion (by their names), restoring
  ///                   terms only: sin θ, cos θ sin φ, cos θ cos φ; none of a heading
  ///     auto:degrees  auto, with angles in degrees whatever their names
  ///     linear        every input
  ///     quadratic     x, x|x| and xy of every input; xy of velocities only, if kMostTerms is
  ///                   exceeded
  ///     fossen        u, v, r, u|u|, v|v|, r|r|, uv, ur, vr, r², n⁺², −n⁻² of every thruster
  ///     fossen:3      fossen with another number of velocities than targets
  ///     manoeuvring   fossen, u|v|, v|u|, ... of every pair, and all squares of velocities
  ///     6dof          fossen with the products and squares of all six velocities
  ///     u*r; th1*|th1|; …    formulas (Expression), separated by semicolons
  ///
  /// For `fossen`, `manoeuvring` and `6dof` the first `velocities` inputs are velocities, in the
  /// order of the targets; the other inputs are thrusters. Throws InputError on an invalid
  /// specification and on more than kMostTerms terms.
  static TermSet from(std::string_view specification, std::span<const std::string> inputs,
                      std::size_t velocities);

  /// The terms of a model in open loop: `fossen` with any inputs as velocities, and of commands n,
  /// n v|v| and n v of the first velocity, n m|m| of up to three commands, and restoring terms of
  /// the attitude.
  /// With room in kMostOpenLoopTerms, the cross flow and the squares of `manoeuvring`, and n v of
  /// every velocity, too. Empty without velocities and above kMostTerms terms.
  static TermSet open_loop(std::span<const std::string> inputs, std::span<const std::size_t> states,
                           const Attitude& attitude = {});
  static constexpr std::size_t kMostOpenLoopTerms = 64;  ///< The cost of a fit is quadratic.

  /// For the least-squares baseline: x and x|x| of every input, products and squares of the first
  /// `velocities` inputs. Throws InputError above kMostTerms terms.
  static TermSet baseline(std::span<const std::string> inputs, std::size_t velocities);

  std::size_t size() const { return terms_.size(); }
  /// Number of terms, the first ones, in a model linear in the commands: all, except the products
  /// with a command in `quadratic`, and with a command and a velocity in open_loop().
  std::size_t without_products() const { return without_products_; }
  /// The inputs with the attitude, of which `auto` has restoring terms only, ascending. The kernel
  /// leaves them out, too.
  const std::vector<std::size_t>& attitude() const { return attitude_; }
  const std::string& text(std::size_t k) const { return terms_[k].text(); }  ///< The formula.
  std::vector<std::string> texts() const;  ///< All formulas, in order. Allocates.
  const Expression& term(std::size_t k) const { return terms_[k]; }  ///< The parsed formula.

  /// The values of all terms at a raw sample; 0 for a term that is not finite. Requires room for
  /// size() values. Allocates nothing.
  void evaluate(std::span<const double> x, std::span<double> out) const;

  /// The power p with φ_k(…, s x_i, …) = s^p φ_k(x) for all s > 0: 0 for a term without input i,
  /// not finite for a term of another form. Allocates nothing.
  double power(std::size_t k, std::size_t input) const;

  /// gradient += Σ weights[k] ∂φ_k/∂x with respect to the raw inputs, with right-hand slopes at
  /// kinks (Expression::slope). Terms and slopes that are not finite count as 0. Requires a weight
  /// per term and room for x.size() values. Allocates nothing.
  void add_gradient(std::span<const double> x, std::span<const double> weights,
                    std::span<double> gradient) const;

  /// The scale of every term: the root mean square, and at least a quarter of the value with all
  /// inputs at twice their root mean square. The lower bound limits the astern term of a thruster
  /// in the first run astern. Both moments are of raw values. Requires a place per term.
  /// Allocates nothing.
  void scales(const Moments& inputs, const Moments& terms, std::span<double> scales) const;

 private:
  static TermSet parsed(const std::vector<std::string>& texts, std::span<const std::string> inputs);

  std::vector<Expression> terms_;
  std::size_t without_products_ = 0;
  std::vector<std::size_t> attitude_;
};

/// A sample for the learners: scaled inputs, then scaled terms. Allocates nothing.
ScaledSample scale_sample(const AxisScaling& scaling, const TermSet& terms,
                          std::span<const double> x);

}  // namespace kelpie
