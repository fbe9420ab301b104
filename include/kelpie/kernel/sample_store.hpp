// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace kelpie {

/// At most `capacity` samples of one dimension, a coordinate at a time (structure of arrays), so
/// that a kernel row runs along contiguous memory. Order is not kept: removing moves the last
/// sample into the gap. Allocates in the constructor only.
class SampleStore {
 public:
  SampleStore(std::size_t dimension, std::size_t capacity);

  std::size_t size() const { return size_; }
  std::size_t capacity() const { return capacity_; }
  std::size_t dimension() const { return dimension_; }

  /// Coordinate k of all samples.
  std::span<const double> coordinate(std::size_t k) const {
    return {data_.data() + k * capacity_, size_};
  }
  void get(std::size_t i, std::span<double> x) const;

  void push_back(std::span<const double> x);  ///< Requires size() < capacity().
  void remove(std::size_t i);                 ///< The last sample takes the number i.
  void clear() { size_ = 0; }

 private:
  std::size_t dimension_;
  std::size_t capacity_;
  std::size_t size_ = 0;
  std::vector<double> data_;
};

}  // namespace kelpie
