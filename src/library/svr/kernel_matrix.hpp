// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/roomy_vector.hpp"
#include "kelpie/core/archive.hpp"
#include "kelpie/svr/resources.hpp"

namespace kelpie {

/// The symmetric matrix K_ij = κ(x_i, x_j) of a buffer's samples. Numbering as SampleStore: after
/// the removal of i the last sample has the number i. The diagonal is stored in double precision in
/// either storage, to preserve a ridge. Memory: capacity² elements, allocated in the constructor.
class KernelMatrix {
 public:
  /// Allocates for `capacity` samples.
  explicit KernelMatrix(std::size_t capacity, Storage storage = Storage::float64);

  std::size_t size() const { return diagonal_.size(); }
  std::size_t capacity() const { return capacity_; }

  /// K_ij of two samples.
  double operator()(std::size_t i, std::size_t j) const {
    if (!singles_.empty()) {
      return i == j ? diagonal_[i] : static_cast<double>(singles_[i * stride_ + j]);
    }
    return doubles_[i * stride_ + j];
  }
  std::span<const double> diagonal() const { return diagonal_; }

  /// Σ_j K_ij v_j. Requires a value per sample. Cost O(n).
  double dot(std::size_t i, std::span<const double> v) const;

  /// out += Σ_k weights[k] · row rows[k]. Requires room for size() values. Cost O(n · rows).
  void combine(std::span<const std::size_t> rows, std::span<const double> weights,
               std::span<double> out) const;

  /// Copies the first out.size() elements of row i. Cost O(n).
  void row(std::size_t i, std::span<double> out) const;

  /// Copies the elements (i, columns[k]). Cost O(columns).
  void gather(std::size_t i, std::span<const std::size_t> columns, std::span<double> out) const;

  /// Appends a sample with its kernel row against the samples so far and κ(x, x). Cost O(n).
  void add(std::span<const double> row, double self);
  void remove(std::size_t i);          ///< Cost O(n).
  void clear() { diagonal_.clear(); }  ///< Removes all samples.

  /// core/archive.hpp. Includes the elements: recomputed elements would differ by rounding, since
  /// the order of a sum depends on the number of samples.
  void visit(Archive& archive);

  /// Memory of a matrix in bytes.
  static std::size_t bytes(std::size_t capacity, Storage storage);

 private:
  std::size_t capacity_;
  std::size_t stride_;  ///< capacity rounded up, so that all rows are aligned alike
  std::vector<double> doubles_;
  std::vector<float> singles_;    ///< empty with Storage::float64; else doubles_ is empty
  RoomyVector<double> diagonal_;  ///< separate, for contiguous access
};

}  // namespace kelpie
