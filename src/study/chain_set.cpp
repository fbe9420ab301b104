// SPDX-License-Identifier: Apache-2.0
#include "study/chain_set.hpp"

#include <algorithm>

namespace kelpie::study {

ChainSet::ChainSet(const TuneProblem& problem) {
  for (const TuneLog& log : problem.logs) {
    chains_.emplace_back(log.data, log.rows, problem.warmup());
    rungs_ = std::max(rungs_, chains_.back().rungs().size());
  }
}

std::size_t ChainSet::rung_of(std::size_t log, std::size_t rung) const {
  const std::size_t fewer = rungs_ - chains_[log].rungs().size();
  return rung < fewer ? 0 : rung - fewer;
}

std::size_t ChainSet::rows(std::size_t rung) const {
  std::size_t rows = 0;
  for (std::size_t log = 0; log < logs(); ++log) {
    rows += chains_[log].rungs()[rung_of(log, rung)].rows;
  }
  return rows;
}

}  // namespace kelpie::study
