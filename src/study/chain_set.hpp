// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "study/forward_chain.hpp"
#include "study/tune_problem.hpp"

namespace kelpie::study {

/// The forward chains of a search's logs, whose rungs are climbed together. A log too short for as
/// many rungs as another stays on its first until the others have come as far: all end on their
/// last, on all rows.
class ChainSet {
 public:
  /// Requires that `problem` outlives it. Throws what ForwardChain throws.
  explicit ChainSet(const TuneProblem& problem);

  std::size_t logs() const { return chains_.size(); }
  std::size_t rungs() const { return rungs_; }  ///< those of the log that has the most
  const ForwardChain& operator[](std::size_t log) const { return chains_[log]; }

  /// Which of a log's own rungs belongs to one of all together.
  std::size_t rung_of(std::size_t log, std::size_t rung) const;
  /// Rows of a rung, in all logs together.
  std::size_t rows(std::size_t rung) const;

 private:
  std::vector<ForwardChain> chains_;
  std::size_t rungs_ = 0;
};

}  // namespace kelpie::study
