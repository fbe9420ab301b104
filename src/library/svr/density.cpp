// SPDX-License-Identifier: Apache-2.0
#include "svr/density.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace kelpie {
namespace {

// Rows are taken in pieces of this many samples, so that they fit the stack.
constexpr std::size_t kPiece = 256;

}  // namespace

KernelDensity::KernelDensity(std::size_t dimension, std::size_t capacity, double bandwidth)
    : bandwidth_(bandwidth),
      kernel_(0.5 / (bandwidth * bandwidth)),
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

void KernelDensity::assume(std::span<const double> sums) {
  size_ = sums.size();
  std::ranges::copy(sums, sum_.begin());
}

double KernelDensity::novelty(std::span<const double> z, const SampleStore& samples) const {
  std::array<double, kPiece> room;  // NOLINT(*-member-init): every element is written first
  const auto for_each_kappa = [&](auto look) {
    for (std::size_t first = 0; first < size_; first += kPiece) {
      const std::span<double> row = std::span(room).first(std::min(kPiece, size_ - first));
      kernel_.row(z, samples, first, row);
      for (std::size_t j = 0; j < row.size(); ++j) {
        look(first + j, row[j]);
      }
    }
  };
  double own = 0.0;
  for_each_kappa([&](std::size_t, double kappa) { own += kappa; });
  if (own < kEmptyDensity) {
    return 1.0;
  }
  const double denser_than = own * (1.0 + kRounding);
  std::size_t denser = 0;
  // sum_ holds everyone's κ = 1 with themselves, which doesn't count.
  for_each_kappa(
      [&](std::size_t j, double kappa) { denser += sum_[j] - 1.0 + kappa > denser_than ? 1 : 0; });
  return static_cast<double>(denser) / static_cast<double>(size_);
}

void KernelDensity::visit(Archive& archive, std::size_t samples) {
  if (archive.loading()) {
    size_ = samples;
  }
  archive.numbers(std::span(sum_).first(samples));
}

}  // namespace kelpie
