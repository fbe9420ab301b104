// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "kelpie/core/matrix.hpp"

namespace kelpie {

/// Result for one parameter.
enum class ParameterState : std::uint8_t {
  known,       ///< given: the inertia in the denominator of all ratios, or the source of the scale
  identified,  ///< estimated
  at_bound,    ///< the constraint on the sign is active
  not_told,    ///< not determined by the log: the value alone is meaningless
};

/// Estimate of one parameter.
struct FittedParameter {
  std::string name;  ///< "sway_inertia", "th1.forward"
  double value = 0.0;
  double error = 0.0;  ///< standard error
  ParameterState state = ParameterState::identified;
  bool scales = true;  ///< proportional to the scale of forces; angles, arms and times are not
};

/// Parameters of an equation of motion, estimated from a log.
struct ParameterFit {
  std::vector<FittedParameter> parameters;  ///< ratios to the surge inertia until scaled
  Matrix covariance;                        ///< of all parameters
  double misfit = 1.0;      ///< χ² of the structure over its expectation, at least 1
  std::size_t windows = 0;  ///< number of windows in the fit
  double window_s = 0.0;    ///< length of a window

  double correlation(std::size_t a, std::size_t b) const;  ///< Of two parameters; 0 without error.
};

/// Scales masses, drags and forces so that the named thrusters have the given forward coefficients
/// ("NAME.forward"), without error; for several thrusters in the geometric mean. Throws InputError
/// on an unknown or undetermined thruster and on a coefficient <= 0.
void scale_by_thrust(ParameterFit& fit, const std::vector<std::pair<std::string, double>>& forward);

/// Scales masses, drags and forces so that the surge inertia, the first parameter, is `kilograms`,
/// with a standard error of `error`. Requires kilograms > 0.
void scale_by_inertia(ParameterFit& fit, double kilograms, double error);

/// scale_by_thrust() of a copy.
template <typename Fit>
Fit scaled_by_thrust(Fit fit, const std::vector<std::pair<std::string, double>>& forward) {
  scale_by_thrust(fit, forward);
  return fit;
}

/// scale_by_inertia() of a copy.
template <typename Fit>
Fit scaled_by_inertia(Fit fit, double kilograms, double error) {
  scale_by_inertia(fit, kilograms, error);
  return fit;
}

}  // namespace kelpie
