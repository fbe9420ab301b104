// SPDX-License-Identifier: Apache-2.0
#include "svr/svr_function.hpp"

#include <algorithm>
#include <functional>

#include "core/vector.hpp"

namespace kelpie {

SvrFunction::SvrFunction(const MixedKernel& kernel, std::size_t capacity)
    : kernel_(kernel),
      samples_(kernel.inputs(), capacity),
      beta_(capacity),
      term_weights_(kernel.terms()) {}

void SvrFunction::assign(const SampleStore& samples, std::span<const double> beta, double bias) {
  take_over(samples, beta, bias);
  for (std::size_t k = 0; k < term_weights_.size(); ++k) {
    term_weights_[k] =
        kernel_.weights().lambda * dot(beta, samples.coordinate(kernel_.inputs() + k));
  }
}

void SvrFunction::assign(const SampleStore& centres, std::span<const double> beta,
                         std::span<const double> term_weights, double bias) {
  take_over(centres, beta, bias);
  std::ranges::copy(term_weights, term_weights_.begin());
}

void SvrFunction::take_over(const SampleStore& samples, std::span<const double> beta, double bias) {
  samples_.assign_weighted(samples, beta);
  std::ranges::copy_if(beta, beta_.begin(), [](double weight) { return weight != 0.0; });
  bias_ = bias;
}

void SvrFunction::assign(const SvrFunction& other) {
  samples_.assign(other.samples_);
  std::ranges::copy(other.beta(), beta_.begin());
  std::ranges::copy(other.term_weights_, term_weights_.begin());
  bias_ = other.bias_;
}

void SvrFunction::add(std::span<const double> weights) {
  std::ranges::transform(term_weights_, weights.first(term_weights_.size()), term_weights_.begin(),
                         std::plus{});
  bias_ += weights.back();
}

void SvrFunction::clear() {
  samples_.clear();
  std::ranges::fill(term_weights_, 0.0);
  bias_ = 0.0;
}

void SvrFunction::visit(Archive& archive) {
  archive.part("samples", samples_);
  archive.numbers(std::span(beta_).first(samples_.size()));
  archive.numbers(term_weights_);
  archive.number(bias_);
}

double SvrFunction::operator()(std::span<const double> x) const {
  return bias_ + dot(kernel_.terms_of(x), term_weights_) + kernel_.expansion(x, samples_, beta()) +
         kernel_.fine_expansion(x, samples_, beta());
}

double SvrFunction::with_gradient(std::span<const double> x, std::span<double> gradient) const {
  std::ranges::copy(term_weights_, gradient.subspan(kernel_.inputs()).begin());
  return bias_ + dot(kernel_.terms_of(x), term_weights_) +
         kernel_.expansion_with_gradient(x, samples_, beta(), gradient.first(kernel_.inputs()));
}

}  // namespace kelpie
