// SPDX-License-Identifier: Apache-2.0
#include "kelpie/kernel/sample_store.hpp"

namespace kelpie {

SampleStore::SampleStore(std::size_t dimension, std::size_t capacity)
    : dimension_(dimension), capacity_(capacity), data_(dimension * capacity) {}

void SampleStore::get(std::size_t i, std::span<double> x) const {
  for (std::size_t k = 0; k < dimension_; ++k) {
    x[k] = data_[k * capacity_ + i];
  }
}

void SampleStore::push_back(std::span<const double> x) {
  for (std::size_t k = 0; k < dimension_; ++k) {
    data_[k * capacity_ + size_] = x[k];
  }
  ++size_;
}

void SampleStore::remove(std::size_t i) {
  --size_;
  for (std::size_t k = 0; k < dimension_; ++k) {
    data_[k * capacity_ + i] = data_[k * capacity_ + size_];
  }
}

}  // namespace kelpie
