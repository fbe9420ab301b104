// SPDX-License-Identifier: Apache-2.0
#include "lab/fossen_terms.hpp"

#include <algorithm>
#include <cmath>

namespace kelpie::lab {

FossenTerms::Values FossenTerms::operator()(std::span<const double> x) const {
  Values terms(static_cast<Eigen::Index>(size()));
  Eigen::Index next = 0;
  const std::span<const double> velocities = x.first(velocities_);
  for (const double velocity : velocities) {
    terms(next++) = velocity;
  }
  for (const double velocity : velocities) {
    terms(next++) = velocity * std::abs(velocity);
  }
  for (std::size_t i = 0; i < velocities_; ++i) {
    for (std::size_t j = i + 1; j < velocities_; ++j) {
      terms(next++) = velocities[i] * velocities[j];
    }
  }
  terms(next++) = velocities.back() * velocities.back();
  for (const double speed : x.subspan(velocities_)) {
    const double ahead = std::max(speed, 0.0);
    const double astern = std::min(speed, 0.0);
    terms(next++) = ahead * ahead;
    terms(next++) = -astern * astern;
  }
  terms(next) = 1.0;
  return terms;
}

}  // namespace kelpie::lab
