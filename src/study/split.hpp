// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "log/dataset.hpp"

namespace kelpie::study {

/// How rows are held out for validation.
enum class SplitKind {
  random,  ///< a share of the rows of each configuration at random (the paper's); rows beside each
           ///< other in time are nearly equal, so training rows tell of held-out ones: it leaks
  blocks,  ///< every so many blocks of rows, counted within each configuration
  pieces,  ///< the same with 25 blocks of equal length, whatever the rows
  tail,    ///< the last rows of each configuration
  column,  ///< the rows that a column of the log marks with 1
  none,    ///< none: all rows are learned
  automatic,  ///< "auto": blocks, or pieces where a configuration has too few rows for blocks
};

/// Which rows are held out.
struct SplitSettings {
  SplitKind kind = SplitKind::blocks;
  double held_out = 0.2;         ///< random, tail: share of rows, in (0, 1)
  std::size_t block_rows = 400;  ///< blocks: rows in one block
  /// blocks, pieces: one in so many is held out, the last of each five.
  std::size_t every = 5;
  std::uint64_t seed = 1;  ///< random: which rows
  std::string column{};    ///< column: its name, which has to be the log's Roles::held_out

  void validate() const;  ///< Throws InputError naming the field.
};

/// Row numbers of a dataset, each list in time order, together every row once.
struct Split {
  std::string label;  ///< e.g. "blocks of 400 rows, every 5th held out", for tables
  std::vector<std::size_t> training;
  std::vector<std::size_t> held_out;
};

/// "blocks", "pieces", "tail", "random", "column:NAME", "none" or "auto". Throws InputError naming
/// the choices.
SplitSettings parse_split(const std::string& text, std::uint64_t seed);
std::string to_string(SplitKind kind);  ///< As parse_split() reads it.

/// Splits each configuration by itself; its rows may lie anywhere in the dataset. Ensures that both
/// lists hold rows of every configuration (but with `none`, which holds out none). Throws
/// InputError on settings out of range, no rows, and a configuration too short, saying how many
/// rows it needs. Requires rows marked by a column where the kind is `column`.
Split make_split(const log::Dataset& data, const SplitSettings& settings);

/// For who judges by held-out rows. Throws InputError where a split has none.
void require_held_out(const Split& split);

}  // namespace kelpie::study
