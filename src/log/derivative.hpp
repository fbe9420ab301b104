// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "log/signal.hpp"

namespace kelpie::log {

/// Where the window of the filter lies.
enum class FilterWindow {
  centred,  ///< around the time asked for: logs, where what came later is known
  causal,   ///< up to it: what a live learner can have
};

/// The slope of a polynomial fitted to a window of samples by least squares: Savitzky and Golay's
/// filter (Anal. Chem. 36, 1964), here for stamps of any spacing.
struct DerivativeSettings {
  FilterWindow window = FilterWindow::centred;
  double window_s = 0.5;  ///< width of the window [s], > 0
  int degree = 2;         ///< of the polynomial, 1 to 4

  void validate() const;  ///< Throws InputError naming the field.
};

/// Weights w with Σᵢ wᵢ v(tᵢ) = slope at t of the polynomial fitted to the v(tᵢ); `offsets_s` has
/// the tᵢ − t. Unit 1/s. Exact for polynomials up to `degree`. Requires: more than `degree`
/// offsets, different ones. Cost: O(n degree²); allocates.
std::vector<double> derivative_weights(std::span<const double> offsets_s, int degree);

/// What weights do to a slowly changing acceleration and to noise.
struct DerivativeInfo {
  std::size_t points = 0;  ///< samples in the window
  double delay_s = 0.0;  ///< of an acceleration that changes steadily: −½ Σ wᵢ (tᵢ − t)²
  double noise_gain = 0.0;  ///< σ of the result per σ of white noise on the samples [1/s]: ‖w‖
};
/// Of these weights at these offsets.
DerivativeInfo derivative_info(std::span<const double> offsets_s, std::span<const double> weights);

/// Of a signal sampled every `period_s` seconds, at one of its samples.
DerivativeInfo derivative_info(double period_s, const DerivativeSettings& settings);

/// The derivative at some times. NaN where the window reaches beyond the signal's begin or end, or
/// into a silence longer than `gap_s`, by more than a step (causal: two), and where it holds too
/// few samples.
/// Requires: a tidy signal, valid settings.
std::vector<double> derivative(const Signal& signal, std::span<const double> at_s,
                               const DerivativeSettings& settings, double gap_s);

/// The median step between a signal's stamps [s]; 0 for a single sample.
double median_step_s(const Signal& signal);

}  // namespace kelpie::log
