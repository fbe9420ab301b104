// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace kelpie::jobs {

/// Times of the room's mechanisms. None of them changes a result.
inline constexpr struct Tuning {
  /// Journal: least time between two writes to the disk. By hand: a machine that loses its power
  /// loses the results of one second.
  std::chrono::seconds sync_period{1};
  /// Ranks: time between two looks at the shared stop flag. By hand: a look takes up to
  /// `progress_period` over a network, 0.4 % of this.
  std::chrono::milliseconds stop_poll_period{250};
  /// Ranks: pause of rank 0's thread that serves the shared counter. By hand: 1 ms is 2 % of the
  /// shortest jobs of interest, 50 ms.
  std::chrono::milliseconds progress_period{1};
  /// Ranks: shortest and longest sleep while a rank waits for the others. By hand, measured as less
  /// than 2 % of a core (docs/fleet.md).
  std::chrono::microseconds shortest_sleep{20};
  std::chrono::microseconds longest_sleep{500};
  /// Ranks: how long rank 0 waits for results that another rank has written. By hand: NFS keeps
  /// attributes of folders for up to 60 s.
  std::chrono::seconds visibility_timeout{100};
} kTuning;

}  // namespace kelpie::jobs
