// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <span>
namespace kelpie {
inline Eigen::Map<const Eigen::ArrayXd> stub_(std::span<const double> v) { return {v.data(), (Eigen::Index)v.size()}; }
inline Eigen::Map<Eigen::ArrayXd> stub_(std::span<double> v) { return {v.data(), (Eigen::Index)v.size()}; }
inline double dot(std::span<const double> a, std::span<const double> b) { return (stub_(a) * stub_(b)).sum(); }
inline void add_scaled(double f, std::span<const double> x, std::span<double> y) { stub_(y) += f * stub_(x); }
inline void rotate(double c, double s, std::span<double> x, std::span<double> y) {
  for (std::size_t i = 0; i < x.size(); ++i) { const double a = x[i]; x[i] = c * a + s * y[i]; y[i] = c * y[i] - s * a; }
}
}
