// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "lab/reproduction.hpp"
#include "log/dataset.hpp"
#include "study/split.hpp"

namespace kelpie::lab {

/// A log and its splits, one result of an entry for each.
struct EntryStream {
  const log::Dataset& data;
  const std::vector<study::Split>& splits;
};

/// A learner of the reader's on all streams.
struct EntryRuns {
  std::string key;
  std::string name;
  std::string place;                         ///< FILE.py:CLASS or MODULE:CLASS
  std::vector<std::vector<SeedRun>> runs{};  ///< [stream][split], without status and times
};

/// Runs learners in Python (FILE.py:CLASS or MODULE:CLASS) by the track `paper` of the open
/// benchmark, `python3 -m kelpie.benchmark`, on `threads` processes at a time. Throws InputError
/// where the benchmark refuses an entry or isn't installed, Failure where an entry fails.
std::vector<EntryRuns> run_entries(const std::vector<std::string>& places,
                                   const std::vector<EntryStream>& streams, std::uint64_t seed,
                                   std::size_t threads);

}  // namespace kelpie::lab
