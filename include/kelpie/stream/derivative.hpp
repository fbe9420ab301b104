// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kelpie/stream/signal_history.hpp"

namespace kelpie {

/// Where the window of the filter lies.
enum class FilterWindow {
  centred,  ///< around the time asked for, which is known half a window later
  causal,   ///< up to it
};

/// The slope of a polynomial fitted to a window of samples by least squares: Savitzky and Golay's
/// filter (Anal. Chem. 36, 1964), here for stamps of any spacing.
struct DerivativeSettings {
  FilterWindow window = FilterWindow::centred;
  double window_s = 0.5;  ///< width of the window [s], > 0
  int degree = 2;         ///< of the polynomial, 1 to 4

  double back_s() const;   ///< How far the window reaches back [s] …
  double ahead_s() const;  ///< … and ahead.
  void validate() const;   ///< Throws InputError naming the field.
};

/// What the filter does to a slowly changing acceleration and to noise.
struct DerivativeInfo {
  std::size_t points = 0;  ///< samples in the window
  double delay_s = 0.0;  ///< of an acceleration that changes steadily: −½ Σ wᵢ (tᵢ − t)²
  double noise_gain = 0.0;  ///< σ of the result per σ of white noise on the samples [1/s]: ‖w‖
};

/// Of a signal sampled every `period_s` seconds, at one of its samples. Throws InputError where
/// the window holds too few. Allocates.
DerivativeInfo derivative_info(double period_s, const DerivativeSettings& settings);

/// Weights w with Σᵢ wᵢ v(tᵢ) = slope at t of the polynomial fitted to the v(tᵢ); `offsets_s` has
/// the tᵢ − t. Unit 1/s. Exact for polynomials up to `degree`. Requires: more than `degree`
/// offsets, different ones. By orthogonal polynomials (Forsythe, J. SIAM 5, 1957): O(n degree).
class SlopeWeights {
 public:
  explicit SlopeWeights(std::size_t most);  ///< For up to `most` offsets. Allocates.

  /// The weights, until the next call. Allocates nothing.
  std::span<const double> at(std::span<const double> offsets_s, int degree);

 private:
  std::vector<double> weights_;
  std::vector<double> polynomial_;  // at the offsets, of one degree …
  std::vector<double> before_;      // … and of the degree below
};

/// Takes derivatives of signals, at one time after the other.
class Derivative {
 public:
  /// [s]: so near an edge of the window a sample is inside; stamps are of nanoseconds.
  static constexpr double kRounding = 1e-9;

  /// Of signals that keep up to `most` samples and have silences of `gap_s`. Allocates.
  /// Requires: valid settings.
  Derivative(const DerivativeSettings& settings, double gap_s, std::size_t most);

  /// NaN where the window reaches beyond the samples' begin or end, or into a silence, by more than
  /// their mean step (causal: two steps), and where it holds too few samples. Allocates nothing.
  double at(const SignalHistory& signal, double t);

 private:
  bool reaches_back(const SignalHistory& signal, std::size_t first, double edge, double step) const;
  bool reaches_ahead(const SignalHistory& signal, std::size_t end, double edge, double step) const;

  DerivativeSettings settings_;
  double gap_s_;
  std::vector<double> offsets_s_;
  SlopeWeights weights_;
};

}  // namespace kelpie
