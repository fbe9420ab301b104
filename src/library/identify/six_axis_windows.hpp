// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

#include "identify/six_axis_fit.hpp"
#include "identify/six_axis_structure.hpp"
#include "identify/weak_form.hpp"

namespace kelpie {

/// The parameters of the thrust curve in the order of SixAxisPlace.
inline constexpr std::array<double ThrustCurve::*, SixAxisPlace::curve_size> kThrustCurve{
    &ThrustCurve::lag_s, &ThrustCurve::delay_s, &ThrustCurve::dead_band, &ThrustCurve::exponent};

/// The weak form on six axes: length of windows, thrust curve, and the parameters of the curve by
/// which derivatives are terms.
struct SixAxisWindows {
  WindowShape shape{};
  ThrustCurve curve{};
  std::array<bool, SixAxisPlace::curve_size> sought{};
};

/// The windows of rows, with the terms of the structure without those of the curve. Allocates.
WeakRows weak_rows(const SixAxisRows& rows, const SixAxisStructure& structure,
                   const SixAxisWindows& windows);

/// With the terms of the curve: derivatives of the forces at `parameters`, zero for a parameter
/// that is not sought. Allocates.
WeakRows weak_rows(const SixAxisRows& rows, const SixAxisStructure& structure,
                   const SixAxisWindows& windows, const Eigen::VectorXd& parameters);

}  // namespace kelpie
