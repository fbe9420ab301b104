// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kelpie/core/archive.hpp"

namespace kelpie {

/// At most `capacity` samples of one dimension, stored by coordinate (structure of arrays): a
/// kernel row then reads contiguous memory. The order is not stable: a removal moves the last
/// sample into the gap. Allocates in the constructor only.
class SampleStore {
 public:
  SampleStore(std::size_t dimension, std::size_t capacity);  ///< Allocates for `capacity` samples.

  std::size_t size() const { return size_; }
  std::size_t capacity() const { return capacity_; }
  std::size_t dimension() const { return dimension_; }

  /// Coordinate k of all samples.
  std::span<const double> coordinate(std::size_t k) const {
    return {data_.data() + k * stride_, size_};
  }
  /// Coordinate k of sample i is data()[k · stride() + i]. Every coordinate is padded for access by
  /// whole vectors.
  const double* data() const { return data_.data(); }
  std::size_t stride() const { return stride_; }

  /// The first x.size() coordinates of sample i.
  void get(std::size_t i, std::span<double> x) const;

  void set(std::size_t i, std::span<const double> x);  ///< The first x.size() coordinates.

  void push_back(std::span<const double> x);  ///< Requires size() < capacity().
  void remove(std::size_t i);                 ///< The last sample gets the number i.
  void clear() { size_ = 0; }                 ///< Removes all samples.

  /// Copies the samples with weights other than 0, in order, and of each the first dimension()
  /// coordinates. Requires at least this dimension, enough room, and a weight per sample. Cost
  /// O(n d).
  void assign_weighted(const SampleStore& other, std::span<const double> weights);

  /// Copies the samples, and of each the first dimension() coordinates. Requires at least this
  /// dimension and enough room. Cost O(n d). Allocates nothing.
  void assign(const SampleStore& other);

  void visit(Archive& archive);  ///< core/archive.hpp

  /// Memory of a store in bytes.
  static std::size_t bytes(std::size_t dimension, std::size_t capacity);

 private:
  std::size_t dimension_;
  std::size_t capacity_;
  std::size_t stride_;
  std::size_t size_ = 0;
  std::vector<double> data_;
};

}  // namespace kelpie
