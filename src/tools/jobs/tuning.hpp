// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace kelpie::jobs {

/// The period of the journal, chosen by hand; no period changes a result.
inline constexpr struct Tuning {
  /// Journal: least time between two writes to the disk. A power failure loses the results of a
  /// second.
  std::chrono::seconds sync_period{1};
} kTuning;

}  // namespace kelpie::jobs
