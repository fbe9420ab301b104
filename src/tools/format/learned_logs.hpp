// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "file/json.hpp"
#include "log/dataset.hpp"

namespace kelpie::format {

/// The fingerprint of a learned log. Counted are rows with a finite number in every input and
/// target, in the order of the log, with commands before any alignment.
struct LearnedLog {
  std::size_t rows = 0;  ///< learned and held-out rows
  std::string checksum;  ///< of inputs and targets
  /// First and last row of each held-out stretch, from 0, ascending.
  std::vector<std::pair<std::size_t, std::size_t>> held_out{};

  /// Whether the dataset has the same rows. Requires commands before alignment.
  bool is_of(const log::Dataset& data) const;
  bool operator==(const LearnedLog&) const = default;
};

/// The fingerprint of a dataset, without held-out rows. Requires commands before alignment.
LearnedLog learned_log(const log::Dataset& data);

/// Adds held-out rows to consecutively learned logs. `held_out`: ascending row numbers over the
/// joined logs.
std::vector<LearnedLog> with_held_out(std::vector<LearnedLog> logs,
                                      std::span<const std::size_t> held_out);

/// Per row of the dataset: held out in every learned log with the same rows. Empty where no log
/// matches. Requires commands before alignment.
std::vector<bool> held_out_rows(std::span<const LearnedLog> logs, const log::Dataset& data);

file::Json learned_json(std::span<const LearnedLog> logs);
/// Reads the output of learned_json(). Throws InputError (file, key) on other content.
std::vector<LearnedLog> read_learned(const file::JsonNode& node);

}  // namespace kelpie::format
