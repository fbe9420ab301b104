// SPDX-License-Identifier: Apache-2.0
#include "model/errors_by_effect.hpp"

#include <algorithm>
#include <cmath>

namespace kelpie {

// The first octave has all effects below two usual errors.
std::size_t ErrorsByEffect::octave(double effect) const {
  const double octaves = std::log2(effect / value());
  constexpr double kLast = kOctaves - 1;
  return octaves >= 1.0 ? static_cast<std::size_t>(std::min(octaves, kLast)) : 0;
}

void ErrorsByEffect::add_with(double error, double effect) {
  if (std::isfinite(value()) && value() > 0.0) {
    by_octave_[octave(effect)].add(error);
  }
}

double ErrorsByEffect::ratio(double effect) const {
  if (!std::isfinite(value()) || !(value() > 0.0)) {
    return 1.0;
  }
  double ratio = 1.0;
  const std::size_t last = octave(effect);
  for (std::size_t k = 0; k <= last; ++k) {
    const double told = by_octave_[k].value();
    ratio = std::isfinite(told) ? std::max(1.0, told / value()) : k > 0 ? 2.0 * ratio : 1.0;
  }
  for (std::size_t k = last; k < kOctaves; ++k) {
    if (const double told = by_octave_[k].value(); std::isfinite(told)) {
      return std::min(ratio, std::max(1.0, told / value()));
    }
  }
  return ratio;
}

void ErrorsByEffect::clear() {
  all_.clear();
  std::ranges::for_each(by_octave_, &RobustScale::clear);
}

void ErrorsByEffect::visit(Archive& archive) {
  archive.part("all", all_);
  std::ranges::for_each(by_octave_, [&](RobustScale& one) { archive.part("octave", one); });
}

}  // namespace kelpie
