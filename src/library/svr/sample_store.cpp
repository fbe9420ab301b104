// SPDX-License-Identifier: Apache-2.0
#include "svr/sample_store.hpp"

#include <algorithm>

namespace kelpie {
namespace {

constexpr std::size_t kWidest = 8;  // doubles in the widest vector there is (AVX-512)

// Room for whole vectors to be read from any sample on.
std::size_t room_for(std::size_t capacity) {
  return (capacity + 2 * kWidest - 1) / kWidest * kWidest;
}

}  // namespace

SampleStore::SampleStore(std::size_t dimension, std::size_t capacity)
    : dimension_(dimension),
      capacity_(capacity),
      stride_(room_for(capacity)),
      data_(dimension * stride_) {}

void SampleStore::get(std::size_t i, std::span<double> x) const {
  for (std::size_t k = 0; k < x.size(); ++k) {
    x[k] = data_[k * stride_ + i];
  }
}

void SampleStore::set(std::size_t i, std::span<const double> x) {
  for (std::size_t k = 0; k < x.size(); ++k) {
    data_[k * stride_ + i] = x[k];
  }
}

void SampleStore::push_back(std::span<const double> x) {
  for (std::size_t k = 0; k < dimension_; ++k) {
    data_[k * stride_ + size_] = x[k];
  }
  ++size_;
}

void SampleStore::remove(std::size_t i) {
  --size_;
  for (std::size_t k = 0; k < dimension_; ++k) {
    data_[k * stride_ + i] = data_[k * stride_ + size_];
  }
}

void SampleStore::assign_weighted(const SampleStore& other, std::span<const double> weights) {
  for (std::size_t k = 0; k < dimension_; ++k) {
    const double* const from = other.data() + k * other.stride();
    double* const to = data_.data() + k * stride_;
    size_ = 0;
    for (std::size_t i = 0; i < other.size(); ++i) {
      to[size_] = from[i];  // overwritten by the next where the weight is 0
      size_ += weights[i] != 0.0 ? 1 : 0;
    }
  }
}

void SampleStore::assign(const SampleStore& other) {
  size_ = other.size();
  for (std::size_t k = 0; k < dimension_; ++k) {
    std::ranges::copy(other.coordinate(k), data_.data() + k * stride_);
  }
}

void SampleStore::visit(Archive& archive) {
  archive.length(size_, capacity_, dimension_ * sizeof(double));
  for (std::size_t k = 0; k < dimension_; ++k) {
    archive.numbers({data_.data() + k * stride_, size_});
  }
}

std::size_t SampleStore::bytes(std::size_t dimension, std::size_t capacity) {
  return dimension * room_for(capacity) * sizeof(double);
}

}  // namespace kelpie
