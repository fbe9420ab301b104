// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "kelpie/stream/stream_plan.hpp"
#include "live/row_queue.hpp"
#include "log/dataset.hpp"
#include "log/plausibility.hpp"

namespace kelpie::live {

/// Checks the rows of a live run by the rules for logs (log::all_mistakes), two minutes of rows at
/// a time, thinned to at most 50 Hz. For one thread. Memory: the rows of two minutes.
class RowCheck {
 public:
  /// `states`: the setting of this name.
  RowCheck(const StreamPlan& plan, std::string states);

  /// Takes a row. Returns the certain mistakes of the last two minutes where these are complete,
  /// else none. Cost O(1), with a check O(rows). Allocates.
  std::vector<log::Mistake> take(const Row& row);

  /// The mistakes of the rows since the last check, where these are enough for a check.
  std::vector<log::Mistake> finish();

 private:
  std::string states_;
  std::size_t thinning_;  // of so many rows, one is taken
  std::size_t due_;       // rows of a check
  std::size_t passed_ = 0;
  log::Dataset rows_;
};

}  // namespace kelpie::live
