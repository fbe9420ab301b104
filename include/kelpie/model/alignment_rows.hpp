// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kelpie/model/alignment_search.hpp"

namespace kelpie {

/// The rows of an AlignmentProblem by their columns, tidy: clipped to the range of most values
/// widened by its half on either side, and divided by the largest that is left.
class AlignmentRows {
 public:
  explicit AlignmentRows(const AlignmentProblem& problem);  ///< Takes its rows over.

  std::size_t size() const { return rows_.size(); }

  /// The row in use nearest to so many rows of the log after the `i`-th, of the same stretch.
  std::size_t shifted(std::size_t i, int shift) const;

  std::vector<std::vector<double>> inputs;   ///< [input][row in use]
  std::vector<std::vector<double>> targets;  ///< [target][row in use]

 private:
  std::span<const std::size_t> rows_;
  std::vector<std::size_t> first_;  // of the stretch of each row in use
  std::vector<std::size_t> last_;
};

}  // namespace kelpie
