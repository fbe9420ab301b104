// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kelpie {

/// A unit of measurement as a product of powers of named ones, for display: nothing is converted.
class Unit {
 public:
  Unit() = default;  ///< of a plain number

  /// Reads `m/s^2`, `m s^-2`, `N*m/(rad/s)^2`, `kg·m²`, `1/s`, `1`. As in the SI, a blank
  /// multiplies and everything is taken from left to right, so `m/s kg` is (m/s) kg. A name is of
  /// letters, `%` or `°`. Throws InputError showing the text and where it goes wrong.
  static Unit parse(std::string_view text);

  /// The unit of this name.
  static Unit named(std::string name);

  Unit operator*(const Unit& other) const;                                       ///< Of a product.
  Unit operator/(const Unit& other) const { return *this * other.power(-1.0); }  ///< Of a quotient.
  Unit power(double exponent) const;                                             ///< Of a power.

  bool operator==(const Unit& other) const = default;

  /// As powers, positive ones first: `m rev^-2`; `1` for a plain number. parse() reads it back.
  std::string text() const;

 private:
  std::vector<std::pair<std::string, double>> powers_;  ///< by name; none is 0
};

}  // namespace kelpie
