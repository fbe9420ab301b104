// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace kelpie::file {

/// Bounds of what is read, chosen by hand; no measurement recorded. reference/limits.md lists them.
inline constexpr struct Tuning {
  std::size_t configuration_bytes = 4'000'000;  ///< of TOML, YAML and .msg files
  std::size_t document_bytes = 256'000'000;     ///< of models, checkpoints, memory files
  std::size_t study_bytes = 2'000'000'000;      ///< of the study.json of an earlier study
  std::size_t table_bytes = 1'000'000'000;      ///< of CSV, packed or not
  std::size_t free_unpacked = 32'000'000;       ///< unpacked bytes always accepted …
  std::size_t most_ratio = 100;                 ///< … and beyond, per packed byte
  int silence_ms = 5000;       ///< of a pipe, before a message says that the program waits
  double largest_toml = 1e12;  ///< number in a configuration, in the unit of the key
} kTuning{};

}  // namespace kelpie::file
