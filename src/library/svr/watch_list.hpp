// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/roomy_vector.hpp"
#include "svr/kernel_matrix.hpp"

namespace kelpie {

/// The samples with residuals near an edge of the tube, with their kernel values against the moving
/// samples: the only samples a step along the path visits. Nine of ten samples that join the free
/// set are among the hundred nearest to their edge at the begin of the path.
/// Memory: places × capacity doubles, allocated in the constructor.
class WatchList {
 public:
  /// Room for `places` watched samples of `capacity` samples.
  WatchList(std::size_t places, std::size_t capacity);

  std::size_t places() const { return places_; }
  std::span<const std::size_t> watched() const { return watched_; }
  std::span<const std::size_t> movers() const { return movers_; }
  /// Whether a sample is watched.
  bool watches(std::size_t sample) const { return place_[sample] != kNowhere; }

  /// Adds a watched sample. Requires a free place and an unwatched sample. Cost O(movers).
  void watch(const KernelMatrix& kernel, std::size_t sample);
  void unwatch(std::size_t sample);  ///< Requires a watched sample. Cost O(movers).

  /// Adds a moving sample. Cost O(watched).
  void add_mover(const KernelMatrix& kernel, std::size_t sample);
  void remove_mover(std::size_t sample);  ///< Requires a mover.

  /// Changes the number of a sample.
  void renumber(std::size_t from, std::size_t to);
  void clear();  ///< Removes watched samples and movers.

  /// out[k] = Σ_j K_kj d[j] over the movers j, for the k-th watched sample; `d` is indexed by
  /// sample. Cost O(watched · movers).
  void products(std::span<const double> d, std::span<double> out) const;

  /// core/archive.hpp: the lists; values are copied from the kernel matrix.
  void visit(Archive& archive, const KernelMatrix& kernel);

  /// Memory of a list in bytes, beside the object itself.
  static std::size_t bytes(std::size_t places, std::size_t capacity);

 private:
  static constexpr std::ptrdiff_t kNowhere = -1;

  double* row(std::size_t place) { return values_.data() + place * stride_; }
  const double* row(std::size_t place) const { return values_.data() + place * stride_; }

  std::size_t places_;
  std::size_t stride_;
  RoomyVector<std::size_t> watched_;
  std::vector<std::ptrdiff_t> place_;  ///< of every sample in `watched_`
  RoomyVector<std::size_t> movers_;
  std::vector<std::ptrdiff_t> column_;  ///< of every sample in `movers_`
  std::vector<double> values_;          ///< K of watched against movers, row after row
  std::vector<double> column_values_;
  mutable std::vector<double> move_;  ///< d in the order of the movers
};

}  // namespace kelpie
