// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace kelpie {

/// The terms φ(x) of a vehicle's equations of motion in Fossen's structure, as motion/term_set.hpp
/// has them (`manoeuvring`), each with what it belongs to, and with 1 and |v|, which a force and a
/// wrong sensor add. Inputs that aren't velocities count as thrusters.
class Basis {
 public:
  /// What a term is of the inputs a and b.
  enum class Form : std::uint8_t {
    one,         ///< 1
    straight,    ///< v
    magnitude,   ///< |v|
    square_law,  ///< v|v|
    square,      ///< v²
    product,     ///< v_a v_b, a before b
    cross_flow,  ///< v_a |v_b|
    command,     ///< n
    ahead,       ///< max(n, 0)²
    astern,      ///< −min(n, 0)²
  };
  /// One term.
  struct Term {
    Form form = Form::one;
    std::size_t a = 0;  ///< an input
    std::size_t b = 0;  ///< another, of products
  };

  /// Of so many inputs, of which `states` are velocities.
  Basis(std::size_t inputs, std::span<const std::size_t> states);

  std::size_t size() const { return terms_.size(); }                        ///< How many terms.
  const Term& term(std::size_t k) const { return terms_[k]; }               ///< One of size().
  const std::vector<std::size_t>& states() const { return states_; }        ///< Inputs, as given.
  const std::vector<std::size_t>& thrusters() const { return thrusters_; }  ///< All others.

  /// The terms at x. Requires room for size() values. Allocates nothing.
  void evaluate(std::span<const double> x, std::span<double> phi) const;

  /// The place of a term, size() where there is none.
  std::size_t find(Form form, std::size_t a = 0, std::size_t b = 0) const;

  bool of_thruster(std::size_t k, std::size_t input) const;  ///< Whether it is thrust of `input`.
  /// Whether the term damps the motion along the velocity `input`: v, |v|, v|v|, v², v|w|.
  bool of_damping(std::size_t k, std::size_t input) const;
  /// The power in which the term has a velocity.
  int degree(std::size_t k, std::size_t input) const;

 private:
  std::vector<Term> terms_;
  std::vector<std::size_t> states_, thrusters_;
};

}  // namespace kelpie
