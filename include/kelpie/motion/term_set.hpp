// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kelpie/core/scaling.hpp"
#include "kelpie/motion/expression.hpp"

namespace kelpie {

/// The physics terms φ(x) of a model: formulas over the raw inputs, in which a vehicle's equations
/// of motion are linear. Each is divided by a scale of its own, so its weight keeps its meaning.
class TermSet {
 public:
  TermSet() = default;  ///< no terms

  /// Reads a specification:
  ///
  ///     none
  ///     auto     quadratic
  ///     linear   every input
  ///     quadratic  x, x|x| and xy of all inputs; where that would be more than kMostTerms,
  ///     products
  ///              of velocities only. Needs no names
  ///     fossen   u, v, r, u|u|, v|v|, r|r|, uv, ur, vr, r², n⁺², −n⁻² of every thruster
  ///     fossen:3 the same with a number of velocities that isn't that of the targets
  ///     manoeuvring   fossen and u|v|, v|u|, ... of every pair, and all squares of velocities
  ///     6dof     fossen with the products and squares of all six velocities
  ///     u*r; th1*|th1|; …    formulas (core/expression.hpp), separated by semicolons
  ///
  /// For `fossen` and `6dof` the first `velocities` inputs are velocities, in the order of the
  /// targets; the others are thrusters. Throws InputError naming what is wrong with the
  /// specification, or more than kMostTerms terms.
  static TermSet from(std::string_view specification, std::span<const std::string> inputs,
                      std::size_t velocities);

  /// The set `manoeuvring` where the velocities are any of the inputs; no terms where there would
  /// be more than kMostTerms.
  static TermSet manoeuvring(std::span<const std::string> inputs,
                             std::span<const std::size_t> states);

  /// What a model in open loop is made of: the set above, and every other input times every
  /// velocity, since the thrust of a propeller depends on its inflow. Without these products where
  /// there would be more than kMostOpenLoopTerms.
  static TermSet open_loop(std::span<const std::string> inputs,
                           std::span<const std::size_t> states);
  static constexpr std::size_t kMostOpenLoopTerms = 64;  ///< A fit costs their square per sample.

  /// For the least-squares baseline: x and x|x| of every input, products and squares of the first
  /// `velocities` inputs. Throws InputError above kMostTerms terms.
  static TermSet baseline(std::span<const std::string> inputs, std::size_t velocities);

  std::size_t size() const { return terms_.size(); }
  /// How many of the terms, the first ones, a straight line through the physics takes: all, but of
  /// `quadratic` only x, x|x| and the products of velocities (named_velocities()), and of
  /// open_loop() those of `manoeuvring`.
  std::size_t without_products() const { return without_products_; }
  /// The formula of a term.
  const std::string& text(std::size_t k) const { return terms_[k].text(); }
  const Expression& term(std::size_t k) const { return terms_[k]; }  ///< A term, to be evaluated.

  /// The values of all terms at a raw sample. Requires room for size() values. Allocates nothing.
  void evaluate(std::span<const double> x, std::span<double> out) const;

  /// gradient += Σ weights[k] ∂φ_k/∂x by the raw inputs; at kinks, slopes to the right
  /// (Expression::slope). A term that isn't finite at x adds nothing, nor does a slope that isn't.
  /// Requires a weight per term and room for x.size() values. Allocates nothing.
  void add_gradient(std::span<const double> x, std::span<const double> weights,
                    std::span<double> gradient) const;

  /// The scale of every term: its root mean square, and no less than a quarter of its value where
  /// all inputs are at twice theirs. So a thruster that hasn't run astern yet doesn't make its term
  /// explode once it does. Both moments are of raw values. Requires a place per term. Allocates
  /// nothing.
  void scales(const Moments& inputs, const Moments& terms, std::span<double> scales) const;

 private:
  static TermSet parsed(const std::vector<std::string>& texts, std::span<const std::string> inputs);

  std::vector<Expression> terms_;
  std::size_t without_products_ = 0;
};

/// One sample as learners take it: scaled inputs, then scaled terms. Allocates nothing. A term that
/// isn't finite at x is 0.
ScaledSample scale_sample(const AxisScaling& scaling, const TermSet& terms,
                          std::span<const double> x);

}  // namespace kelpie
