// SPDX-License-Identifier: Apache-2.0
#include "kelpie/svr/svr_function.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>

namespace kelpie {

SvrFunction::SvrFunction(const SquaredExponential& kernel, std::size_t dimension,
                         std::size_t capacity)
    : kernel_(kernel), samples_(dimension, capacity), beta_(capacity), point_(dimension) {}

void SvrFunction::assign(const SampleStore& samples, std::span<const double> beta, double bias) {
  samples_.clear();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (beta[i] != 0.0) {
      samples.get(i, point_);
      beta_[samples_.size()] = beta[i];
      samples_.push_back(point_);
    }
  }
  bias_ = bias;
}

double SvrFunction::operator()(std::span<const double> z) const {
  constexpr std::size_t kStretch = 256;
  alignas(64) std::array<double, kStretch> row;  // NOLINT: filled as far as it is read
  double sum = bias_;
  for (std::size_t first = 0; first < samples_.size(); first += kStretch) {
    const std::size_t count = std::min(kStretch, samples_.size() - first);
    kernel_.row(z, samples_, first, std::span(row).first(count));
    const auto length = static_cast<Eigen::Index>(count);
    sum += (Eigen::Map<const Eigen::ArrayXd, Eigen::AlignedMax>(row.data(), length) *
            Eigen::Map<const Eigen::ArrayXd>(beta_.data() + first, length))
               .sum();
  }
  return sum;
}

}  // namespace kelpie
