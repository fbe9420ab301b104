// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kelpie/kernel/kernel_matrix.hpp"

namespace kelpie {

/// The samples whose residuals are near an edge of the tube, and their kernel values against the
/// samples that move: all that a step along the path has to look at. Nine of ten samples that join
/// the free set are among the hundred nearest to their edge when the path begins.
/// Memory: places × capacity doubles, allocated in the constructor.
class WatchList {
 public:
  /// Room for `places` watched samples, of `capacity` altogether.
  WatchList(std::size_t places, std::size_t capacity);

  std::size_t places() const { return places_; }
  std::span<const std::size_t> watched() const { return watched_; }
  std::span<const std::size_t> movers() const { return movers_; }
  /// Whether a sample is watched.
  bool watches(std::size_t sample) const { return place_[sample] != kNowhere; }

  /// Starts to watch a sample. Requires a free place, and that it isn't watched. Cost O(movers).
  void watch(const KernelMatrix& kernel, std::size_t sample);
  void unwatch(std::size_t sample);  ///< Requires that it is watched. Cost O(movers).

  /// A sample that may move from now on, or no longer. Cost O(watched).
  void add_mover(const KernelMatrix& kernel, std::size_t sample);
  void remove_mover(std::size_t sample);  ///< Requires that it is a mover.

  /// A sample's number has changed.
  void renumber(std::size_t from, std::size_t to);
  void clear();  ///< Watches nobody any more.

  /// out[k] = Σ_j K_kj d[j] over all movers j, for the k-th watched sample; `d` is laid out by
  /// sample. Cost O(watched · movers).
  void products(std::span<const double> d, std::span<double> out) const;

  /// core/archive.hpp; which samples are watched and which move: the values are the kernel matrix'.
  void visit(Archive& archive, const KernelMatrix& kernel);

  /// Memory of a list in bytes, beside the object itself.
  static std::size_t bytes(std::size_t places, std::size_t capacity);

 private:
  static constexpr std::ptrdiff_t kNowhere = -1;

  double* row(std::size_t place) { return values_.data() + place * stride_; }
  const double* row(std::size_t place) const { return values_.data() + place * stride_; }

  std::size_t places_;
  std::size_t stride_;
  std::vector<std::size_t> watched_;
  std::vector<std::ptrdiff_t> place_;  ///< of every sample among the watched
  std::vector<std::size_t> movers_;
  std::vector<std::ptrdiff_t> column_;  ///< of every sample among the movers
  std::vector<double> values_;          ///< K of watched against movers, row after row
  std::vector<double> column_values_;
  mutable std::vector<double> move_;  ///< d in the order of the movers
};

}  // namespace kelpie
