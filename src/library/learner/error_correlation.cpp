// SPDX-License-Identifier: Apache-2.0
#include "learner/error_correlation.hpp"

#include <algorithm>
#include <cmath>

#include "learner/tuning.hpp"

namespace kelpie {

ErrorCorrelation::ErrorCorrelation() : rows_per_sample_(kOnline.evidence.first) {}

void ErrorCorrelation::add(double error) {
  constexpr const auto& kEvidence = kOnline.evidence;
  const auto place = static_cast<std::size_t>(count_) % kLongest;
  products_[0] = kEvidence.keep * products_[0] + error * error;
  for (std::size_t k = 0; k < kLags; ++k) {
    const double before = errors_[(place + kLongest - (std::size_t{1} << k)) % kLongest];
    products_[k + 1] = kEvidence.keep * products_[k + 1] + error * before;
  }
  errors_[place] = error;
  if (++count_ < kEvidence.least || count_ % kEvidence.every != 0 || !(products_[0] > 0.0)) {
    return;
  }
  double lag = 1.0;
  std::size_t k = 1;
  for (; k < kLags && products_[k] >= 0.5 * products_[0]; ++k) {
    lag *= 2.0;
  }
  const double alike = std::clamp(products_[k] / products_[0], kEvidence.least_alike, 0.5);
  const double next = std::pow(alike, 1.0 / lag);
  rows_per_sample_ = (1.0 + next) / (1.0 - next);
}

void ErrorCorrelation::visit(Archive& archive) {
  archive.numbers(errors_);
  archive.numbers(products_);
  archive.whole(count_);
  archive.number(rows_per_sample_);
}

}  // namespace kelpie
