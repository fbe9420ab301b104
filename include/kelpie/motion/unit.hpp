// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kelpie {

/// A unit of measurement as a product of powers of named units.
class Unit {
 public:
  Unit() = default;  ///< dimensionless

  /// Reads `m/s^2`, `m s^-2`, `N*m/(rad/s)^2`, `kg·m²`, `1/s`, `1`. As in the SI, a blank
  /// multiplies, and operators are evaluated from left to right: `m/s kg` is (m/s) kg. A name has
  /// letters, `%` or `°`; sec, seconds, degrees, radians, meters and RPM are s, deg, rad, m and
  /// rpm. Throws InputError with the text and the place of the error.
  static Unit parse(std::string_view text);

  static Unit named(std::string name);  ///< The unit of this name.

  Unit operator*(const Unit& other) const;                                       ///< Product.
  Unit operator/(const Unit& other) const { return *this * other.power(-1.0); }  ///< Quotient.
  Unit power(double exponent) const;                                             ///< Power.

  /// The unit in the SI, and the size of one in this unit: rad/s and 0.01745 for deg/s. Converted
  /// are deg, °, dps, mrad, mm, cm, km, knots (kn, knot, kt, kts), g (9.80665 m/s²), and with these
  /// or with m and rad also min and h; a unit without any of these is itself. Units of commands
  /// (us, rpm, rev/min, V, %) stay, since actuators are told in the units of commands.
  std::pair<Unit, double> in_si() const;

  bool operator==(const Unit& other) const = default;

  /// Powers, positive exponents first: `m rev^-2`; `1` without a unit. Readable by parse().
  std::string text() const;

 private:
  std::vector<std::pair<std::string, double>> powers_;  ///< by name; none is 0
};

}  // namespace kelpie
