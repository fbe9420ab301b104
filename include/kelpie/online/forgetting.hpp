// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "kelpie/online/sample_collector.hpp"
#include "kelpie/online/settings.hpp"

namespace kelpie {

/// The forgetting node: chooses the samples that leave the buffer, one at a time.
class Forgetting {
 public:
  explicit Forgetting(const OnlineSvrSettings& settings);  ///< Requires settings that validate.

  /// The sample to release: of those that have lost their weight, the one in the densest place,
  /// while there are more of them than stay as anchors. Σβ = 0 gives a lone first sample no weight;
  /// were all of these dropped at once, the buffer would never begin to fill. Cost O(n).
  std::optional<std::size_t> released(const SampleCollector& buffer) const;

  /// The sample to forget while the buffer is over its size: the highest φ (eq. 7). Cost O(n).
  std::optional<std::size_t> forgotten(const SampleCollector& buffer, double now) const;

 private:
  double score(const SampleCollector& buffer, std::size_t i, double now) const;

  ForgetRule rule_;
  double k_;
  std::size_t size_;
  std::size_t anchors_;
};

}  // namespace kelpie
