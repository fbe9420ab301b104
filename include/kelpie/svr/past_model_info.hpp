// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>

#include "kelpie/core/archive.hpp"

namespace kelpie {

/// History and accuracy of a past model.
struct PastModelInfo {
  std::int64_t number = 0;   ///< 1, 2, 3 …, in the order of first storage
  double from_s = 0.0;       ///< first time of its vehicle in service [s]
  double until_s = 0.0;      ///< last time the model was valid [s]
  std::int64_t samples = 0;  ///< learned or rejected in service, until `until_s`
  int recalls = 0;           ///< number of returns into service
  std::int64_t earlier = 0;  ///< part of `samples` from earlier runs; 0: first met in this run
  /// Mean error one step ahead without the short-range part, outliers clipped; positive, at least
  /// ε/2.
  double usual_error = 0.0;

  /// Order of removal from a full store: fewest recalls first, then longest out of service.
  std::pair<int, double> usefulness() const { return {recalls, until_s}; }

  void visit(Archive& archive);  ///< core/archive.hpp
};

}  // namespace kelpie
