// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "kelpie/svr/settings.hpp"
#include "svr/sample_collector.hpp"

namespace kelpie {

/// The forgetting node: selects the samples to remove from the buffer, one per call.
class Forgetting {
 public:
  explicit Forgetting(const OnlineSvrSettings& settings);  ///< Requires settings that validate.

  /// The sample to release: of the samples without weight, if more than `anchors`, the sample in
  /// the densest place. Σβ = 0 gives a lone first sample no weight; without anchors the buffer
  /// would never fill. Cost O(n).
  std::optional<std::size_t> released(const SampleCollector& buffer) const;

  /// The sample to forget from a buffer above its size: the largest φ (eq. 7). Cost O(n).
  std::optional<std::size_t> forgotten(const SampleCollector& buffer, double now) const;

 private:
  double score(const SampleCollector& buffer, std::size_t i, double now) const;

  ForgetRule rule_;
  double k_;
  std::size_t size_;
  std::size_t anchors_;
};

}  // namespace kelpie
