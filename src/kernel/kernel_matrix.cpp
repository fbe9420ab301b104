// SPDX-License-Identifier: Apache-2.0
#include "kelpie/kernel/kernel_matrix.hpp"

#include <algorithm>

namespace kelpie {
namespace {

constexpr std::size_t kLine = 8;  // doubles in a cache line

}  // namespace

KernelMatrix::KernelMatrix(std::size_t capacity)
    : capacity_(capacity),
      stride_((capacity + kLine - 1) / kLine * kLine),
      data_(capacity * stride_),
      diagonal_(capacity) {}

void KernelMatrix::add(std::span<const double> row, double self) {
  double* const last = data_.data() + size_ * stride_;
  for (std::size_t j = 0; j < size_; ++j) {
    last[j] = row[j];
    data_[j * stride_ + size_] = row[j];
  }
  last[size_] = self;
  diagonal_[size_] = self;
  ++size_;
}

void KernelMatrix::remove(std::size_t i) {
  --size_;
  if (i == size_) {
    return;
  }
  const double* const last = data_.data() + size_ * stride_;
  std::copy_n(last, size_, data_.data() + i * stride_);
  for (std::size_t j = 0; j < size_; ++j) {
    data_[j * stride_ + i] = last[j];
  }
  diagonal_[i] = diagonal_[size_];
  data_[i * stride_ + i] = diagonal_[i];
}

}  // namespace kelpie
