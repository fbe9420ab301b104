// SPDX-License-Identifier: Apache-2.0
#include "bag/statistics.hpp"

#include <algorithm>
#include <cmath>

#include "bag/tuning.hpp"
#include "core/quantile.hpp"

namespace kelpie::bag {
namespace {

constexpr double kGainOfDifference = 2.449489742783;  // √(1 + 2² + 1): σ of x₀ - 2x₁ + x₂ per σ

}  // namespace

void Statistics::add(double value) {
  if (!std::isfinite(value)) {
    ++not_finite_;
    on_end_ = 0;
    return;
  }
  ++finite_;
  low_ = std::min(low_, value);
  high_ = std::max(high_, value);
  if (on_end_ >= last_.size() && met_++ % stride_ == 0) {
    if (differences_.size() == kTuning.kept_differences) {
      for (std::size_t i = 0; i < kTuning.kept_differences / 2; ++i) {
        differences_[i] = differences_[2 * i];
      }
      differences_.resize(kTuning.kept_differences / 2);
      stride_ *= 2;
    }
    differences_.push_back(std::abs(last_[0] - 2.0 * last_[1] + value));
  }
  last_ = {last_[1], value};
  ++on_end_;
}

std::optional<double> Statistics::noise() const {
  if (differences_.size() < kTuning.fewest_differences) {
    return std::nullopt;
  }
  std::vector<double> sorted = differences_;
  return robust_deviation(sorted) / kGainOfDifference;
}

}  // namespace kelpie::bag
