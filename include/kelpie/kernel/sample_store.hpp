// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kelpie/core/archive.hpp"

namespace kelpie {

/// At most `capacity` samples of one dimension, a coordinate at a time (structure of arrays), so
/// that a kernel row runs along contiguous memory. Order is not kept: removing moves the last
/// sample into the gap. Allocates in the constructor only.
class SampleStore {
 public:
  SampleStore(std::size_t dimension, std::size_t capacity);  ///< Allocates for so many samples.

  std::size_t size() const { return size_; }
  std::size_t capacity() const { return capacity_; }
  std::size_t dimension() const { return dimension_; }

  /// Coordinate k of all samples.
  std::span<const double> coordinate(std::size_t k) const {
    return {data_.data() + k * stride_, size_};
  }
  /// Coordinate k of sample i is at data()[k · stride() + i]. Behind every coordinate there is
  /// memory enough to read it in whole vectors.
  const double* data() const { return data_.data(); }
  std::size_t stride() const { return stride_; }

  /// The first x.size() coordinates of sample i.
  void get(std::size_t i, std::span<double> x) const;

  void set(std::size_t i, std::span<const double> x);  ///< The first x.size() coordinates.

  void push_back(std::span<const double> x);  ///< Requires size() < capacity().
  void remove(std::size_t i);                 ///< The last sample takes the number i.
  void clear() { size_ = 0; }                 ///< Removes all samples.

  /// Takes over the samples of another store whose `weights` are not 0, in their order, as many of
  /// their coordinates as it has itself. Requires these, room for them, and a weight per sample.
  /// Cost O(n d).
  void assign_weighted(const SampleStore& other, std::span<const double> weights);

  /// Takes over the samples of another store, as many of their coordinates as it has itself.
  /// Requires these and room for them. Cost O(n d). Allocates nothing.
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
