// SPDX-License-Identifier: Apache-2.0
#include "kelpie/svr/svr_function.hpp"

#include <algorithm>

#include "kelpie/core/vector.hpp"

namespace kelpie {

SvrFunction::SvrFunction(const MixedKernel& kernel, std::size_t capacity)
    : kernel_(kernel),
      samples_(kernel.dimension(), capacity),
      beta_(capacity),
      term_weights_(kernel.terms()) {}

void SvrFunction::assign(const SampleStore& samples, std::span<const double> beta, double bias) {
  samples_.assign_weighted(samples, beta);
  std::ranges::copy_if(beta, beta_.begin(), [](double weight) { return weight != 0.0; });
  for (std::size_t k = 0; k < term_weights_.size(); ++k) {
    term_weights_[k] =
        kernel_.weights().lambda * dot(this->beta(), samples_.coordinate(kernel_.inputs() + k));
  }
  bias_ = bias;
}

void SvrFunction::clear() {
  samples_.clear();
  std::ranges::fill(term_weights_, 0.0);
  bias_ = 0.0;
}

double SvrFunction::operator()(std::span<const double> x) const {
  return lasting(x) + kernel_.fine_expansion(x, samples_, beta());
}

double SvrFunction::lasting(std::span<const double> x) const {
  return bias_ + dot(kernel_.terms_of(x), term_weights_) + kernel_.expansion(x, samples_, beta());
}

}  // namespace kelpie
