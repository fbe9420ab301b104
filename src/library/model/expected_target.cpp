// SPDX-License-Identifier: Apache-2.0
#include "model/expected_target.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/eigen.hpp"

namespace kelpie {
namespace {

constexpr const auto& kExpected = kModelTuning.expected;

}  // namespace

ExpectedTarget::ExpectedTarget(const TermSet& terms)
    : terms_(terms),
      fit_(terms.size() + 1, kExpected.prior),
      weights_(terms.size() + 1),
      features_(terms.size() + 1) {}

std::size_t ExpectedTarget::bytes(std::size_t terms) {
  const std::size_t m = terms + 1;
  return (m * (m + 1) + 8 * m) * sizeof(double);
}

void ExpectedTarget::learn(std::span<const double> x, double y, bool doubtful) {
  compute_features(x);
  const double error = y - as_vector(fit_.theta()).dot(as_vector(features_));
  const double root = std::sqrt(usual_error_.huber_weight(error, kExpected.huber));
  usual_error_.add(error);
  as_vector(features_) *= root;
  fit_.add(features_, root * y);
  if (!doubtful) {
    std::ranges::copy(fit_.theta(), weights_.begin());
  }
}

bool ExpectedTarget::expects(std::span<const double> x, double y, double mean) const {
  if (fit_.rows() < kExpected.rows_per_term * static_cast<std::int64_t>(features_.size())) {
    return false;
  }
  compute_features(x);
  const double unexpected = y - as_vector(weights_).dot(as_vector(features_));
  return std::abs(unexpected) < kExpected.unexpected * std::abs(y - mean);
}

void ExpectedTarget::clear() {
  fit_.clear();
  usual_error_.clear();
  std::ranges::fill(weights_, 0.0);
}

void ExpectedTarget::compute_features(std::span<const double> x) const {
  terms_.evaluate(x, std::span(features_).first(terms_.size()));
  features_.back() = 1.0;
}

void ExpectedTarget::visit(Archive& archive) {
  archive.part("fit", fit_);
  archive.numbers(weights_);
  archive.part("usual error", usual_error_);
}

}  // namespace kelpie
