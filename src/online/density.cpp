// SPDX-License-Identifier: Apache-2.0
#include "kelpie/online/density.hpp"

#include <cmath>

namespace kelpie {

KernelDensity::KernelDensity(std::size_t dimension, std::size_t capacity, double bandwidth)
    : kernel_(0.5 / (bandwidth * bandwidth)),
      determinant_(std::pow(bandwidth, static_cast<double>(dimension))),
      sum_(capacity),
      row_(capacity),
      leaving_(dimension) {}

double KernelDensity::scott(std::size_t dimension, std::size_t samples) {
  return std::pow(static_cast<double>(samples), -1.0 / (static_cast<double>(dimension) + 4.0));
}

void KernelDensity::add(std::span<const double> z, const SampleStore& samples) {
  kernel_.row(z, samples, row_);
  double own = 1.0;
  for (std::size_t j = 0; j < size_; ++j) {
    sum_[j] += row_[j];
    own += row_[j];
  }
  sum_[size_++] = own;
}

void KernelDensity::remove(std::size_t i, const SampleStore& samples) {
  samples.get(i, leaving_);
  kernel_.row(leaving_, samples, row_);
  for (std::size_t j = 0; j < size_; ++j) {
    sum_[j] -= row_[j];
  }
  sum_[i] = sum_[--size_];
}

void KernelDensity::visit(Archive& archive, std::size_t samples) {
  if (archive.loading()) {
    size_ = samples;
  }
  archive.numbers(std::span(sum_).first(samples));
}

}  // namespace kelpie
