// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace kelpie::file {

/// Bounds of what is read, chosen by hand; no measurement recorded. reference/limits.md lists them.
inline constexpr struct Tuning {
  std::size_t configuration_bytes = std::size_t{4} << 20U;  ///< of TOML, YAML and .msg files
  std::size_t document_bytes = std::size_t{256} << 20U;  ///< of models, checkpoints, memory files
  std::size_t study_bytes = std::size_t{2} << 30U;       ///< of the study.json of an earlier study
  std::size_t table_bytes = std::size_t{1} << 30U;       ///< of CSV, packed or not
  std::size_t free_unpacked = std::size_t{32} << 20U;    ///< unpacked bytes always accepted …
  std::size_t most_ratio = 100;                          ///< … and beyond, per packed byte
  int silence_ms = 5000;       ///< of a pipe, before a message says that the program waits
  double largest_toml = 1e12;  ///< number in a configuration, in the unit of the key
} kTuning{};

}  // namespace kelpie::file
