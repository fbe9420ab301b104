// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace kelpie::jobs {

/// Periods of the mechanisms of jobs. No period changes a result. All are chosen by hand; no
/// measurement is recorded except where named.
inline constexpr struct Tuning {
  /// Journal: least time between two writes to the disk. A power failure loses the results of a
  /// second.
  std::chrono::seconds sync_period{1};
  /// Ranks: time between two reads of the shared stop flag. A read takes up to `progress_period`
  /// over a network, 0.4 % of 250 ms.
  std::chrono::milliseconds stop_poll_period{250};
  /// Ranks: pause of the thread of rank 0 that serves the shared counter. 1 ms is 2 % of the
  /// shortest jobs of interest, 50 ms.
  std::chrono::milliseconds progress_period{1};
  /// Ranks: shortest and longest sleep of a waiting rank.
  std::chrono::microseconds shortest_sleep{20};
  std::chrono::microseconds longest_sleep{500};
  /// Ranks: longest wait of rank 0 for results written by a further rank. NFS keeps attributes of
  /// folders for up to 60 s by default (acdirmax, nfs(5)).
  std::chrono::seconds visibility_timeout{100};
} kTuning;

}  // namespace kelpie::jobs
