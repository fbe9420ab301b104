// SPDX-License-Identifier: Apache-2.0
#include "kelpie/svr/svr_function.hpp"

#include <algorithm>

namespace kelpie {

SvrFunction::SvrFunction(const SquaredExponential& kernel, std::size_t dimension,
                         std::size_t capacity)
    : kernel_(kernel), samples_(dimension, capacity), beta_(capacity) {}

void SvrFunction::assign(const SampleStore& samples, std::span<const double> beta, double bias) {
  samples_.assign_weighted(samples, beta);
  std::ranges::copy_if(beta, beta_.begin(), [](double weight) { return weight != 0.0; });
  bias_ = bias;
}

double SvrFunction::operator()(std::span<const double> z) const {
  return bias_ + kernel_.expansion(z, samples_, beta());
}

}  // namespace kelpie
