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

/// A log that a model has learned, so that it is known again: its rows with a finite number in
/// every input and target, in their order, commands as they stood in it.
struct LearnedLog {
  std::size_t rows = 0;  ///< learned and held out
  std::string checksum;  ///< of their inputs and targets
  /// First and last of rows that were held out, from 0, going up.
  std::vector<std::pair<std::size_t, std::size_t>> held_out{};

  /// Whether the dataset has the same rows. Its commands must not have been shifted yet.
  bool is_of(const log::Dataset& data) const;
  bool operator==(const LearnedLog&) const = default;
};

/// Of a dataset whose commands haven't been shifted yet; nothing is held out.
LearnedLog learned_log(const log::Dataset& data);

/// The logs, learned one after the other, when of all their rows together these (going up) were
/// held out.
std::vector<LearnedLog> with_held_out(std::vector<LearnedLog> logs,
                                      std::span<const std::size_t> held_out);

/// Whether each row of the dataset was held out of all the learning; empty where none of the logs
/// is of it. Its commands must not have been shifted yet.
std::vector<bool> held_out_rows(std::span<const LearnedLog> logs, const log::Dataset& data);

file::Json learned_json(std::span<const LearnedLog> logs);
/// Throws InputError (file, key) on what learned_json() didn't write.
std::vector<LearnedLog> read_learned(const file::JsonNode& node);

/// Of a model.json; none where it doesn't tell. Throws as read_model() does where it is no JSON.
std::vector<LearnedLog> read_learned_logs(const std::filesystem::path& file);

}  // namespace kelpie::format
