// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "log/dataset.hpp"

namespace kelpie::study {

/// Rules by which rows are held out for validation.
enum class SplitKind {
  random,     ///< a share of the rows of each configuration at random (the paper's); neighbours in
              ///< time are nearly equal, so training rows leak into held-out rows
  blocks,     ///< every so many blocks of rows, counted within each configuration
  pieces,     ///< the same with 25 blocks of equal length
  tail,       ///< the last rows of each configuration
  column,     ///< the rows with 1 in a column of the log
  none,       ///< all rows are learned
  automatic,  ///< "auto": blocks, or pieces where a configuration has too few rows for blocks
};

/// A rule with its parameters.
struct SplitSettings {
  SplitKind kind = SplitKind::blocks;
  double held_out = 0.2;         ///< random, tail: share of rows, in (0, 1)
  std::size_t block_rows = 400;  ///< blocks: rows in one block
  /// blocks, pieces: the last of every so many blocks is held out.
  std::size_t every = 5;
  std::uint64_t seed = 1;  ///< random: seed of the draw
  std::string column{};    ///< column: the log's Roles::held_out

  void validate() const;  ///< Throws InputError naming the field.
};

/// Row numbers of a dataset. Both lists are in time order; every row is in one list.
struct Split {
  std::string label;  ///< e.g. "blocks of 400 rows, every 5th held out", for tables
  std::vector<std::size_t> training;
  std::vector<std::size_t> held_out;
};

/// Reads "blocks", "pieces", "tail", "random", "column:NAME", "none" or "auto". Throws InputError
/// naming the choices.
SplitSettings parse_split(const std::string& text, std::uint64_t seed);
std::string to_string(SplitKind kind);  ///< In the form of parse_split().

/// Splits each configuration by itself, wherever its rows lie in the dataset. Ensures that both
/// lists hold rows of every configuration, except with `none`. Throws InputError on settings out of
/// range, an empty dataset, and a configuration that is too short, naming the needed number of
/// rows. Requires rows marked by a column where the kind is `column`.
Split make_split(const log::Dataset& data, const SplitSettings& wanted);

/// Those of the rows that are of this configuration.
std::vector<std::size_t> of_configuration(const log::Dataset& data, std::vector<std::size_t> rows,
                                          int wanted);

/// The training rows of the configuration `only` (default: of the first training row). Throws
/// InputError (`--only`) without such rows, naming the configurations of the log.
std::vector<std::size_t> training_rows(const log::Dataset& data, const Split& split,
                                       std::optional<int> only);

/// Throws InputError on a split without held-out rows.
void require_held_out(const Split& split);

}  // namespace kelpie::study
