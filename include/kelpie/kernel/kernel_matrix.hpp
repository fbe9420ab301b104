// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kelpie/core/vector.hpp"

namespace kelpie {

/// The symmetric matrix K_ij = κ(x_i, x_j) of a buffer's samples, kept while samples come and go.
/// Numbering follows SampleStore: removing i gives its number to the last sample.
/// Memory: capacity² doubles, allocated in the constructor.
class KernelMatrix {
 public:
  explicit KernelMatrix(std::size_t capacity);

  std::size_t size() const { return size_; }
  std::size_t capacity() const { return capacity_; }

  std::span<const double> row(std::size_t i) const { return {data_.data() + i * stride_, size_}; }
  double operator()(std::size_t i, std::size_t j) const { return data_[i * stride_ + j]; }
  std::span<const double> diagonal() const { return {diagonal_.data(), size_}; }

  double dot(std::size_t i, std::span<const double> v) const { return kelpie::dot(row(i), v); }
  void combine(std::span<const std::size_t> rows, std::span<const double> weights,
               std::span<double> out) const {
    for (std::size_t k = 0; k < rows.size(); ++k) add_scaled(weights[k], row(rows[k]), out);
  }

  /// Appends a sample with its kernel row against the samples so far and κ(x, x). Cost O(n).
  void add(std::span<const double> row, double self);
  void remove(std::size_t i);  ///< Cost O(n).

 private:
  std::size_t capacity_;
  std::size_t stride_;  ///< capacity rounded up, so that all rows are aligned alike
  std::size_t size_ = 0;
  std::vector<double> data_;
  std::vector<double> diagonal_;  ///< beside the matrix: there its elements lie a row apart
};

}  // namespace kelpie
