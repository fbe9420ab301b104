// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

namespace kelpie {

/// Sums over contiguous numbers by the widest instructions of the machine they run on (Highway,
/// chosen at run time). Any length, no alignment needed, nothing is read or written past the end.
/// The order of a sum's terms depends on the machine, so results may differ by rounding between
/// machines; on one machine they are always the same. All are linear in the length and allocate
/// nothing. Requires spans of one call to be of the same length.

double dot(std::span<const double> a, std::span<const double> b);
double dot(std::span<const float> a, std::span<const double> b);  ///< Sums in double.

/// y += factor · x
void add_scaled(double factor, std::span<const double> x, std::span<double> y);
void add_scaled(double factor, std::span<const float> x, std::span<double> y);  ///< The same.

/// A plane rotation: (x, y) ← (c x + s y, c y − s x).
void rotate(double c, double s, std::span<double> x, std::span<double> y);

/// Four vectors, each of the length of the one they are taken with.
template <typename T>
using Four = std::array<const T*, 4>;

/// The four products a_k · b: b is loaded once.
std::array<double, 4> dot(const Four<double>& a, std::span<const double> b);

/// y += Σ factor_k · x_k: y is loaded and stored once.
void add_scaled(const std::array<double, 4>& factors, const Four<double>& x, std::span<double> y);
/// The same.
void add_scaled(const std::array<double, 4>& factors, const Four<float>& x, std::span<double> y);

}  // namespace kelpie
