// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace kelpie::bag {

/// Behavioural constants of the room. "By hand" means: chosen by hand, no measurement recorded.
inline constexpr struct Tuning {
  // Limits on memory and recursion, so that damaged and hostile files end in an error.
  std::size_t most_fields = 20'000;            ///< of a message type; by hand
  std::size_t most_definitions = 64'000'000;   ///< bytes of all topics'; by hand
  std::size_t field_bytes = 100;               ///< that a field counts of these; by hand
  std::size_t most_leaves = 200'000;           ///< of all topics, looked at by inspect; by hand
  std::size_t deepest_type = 32;               ///< types within types; by hand
  std::size_t deepest_struct = 16;             ///< MATLAB: structs within structs; by hand
  std::size_t most_arrays = 20'000;            ///< MATLAB: arrays of a file; by hand
  std::size_t most_elements = 1'000;           ///< MATLAB: structs or cells of an array; by hand
  std::size_t longest_name = 200;              ///< bytes of a variable's or field's; by hand
  std::size_t most_parameters = 4096;          ///< of an autopilot, which has 1,500; by hand
  std::uint64_t most_numbers = 1ULL << 40U;    ///< MATLAB: numbers of an array; by hand
  std::size_t child_free_bytes = 256'000'000;  ///< MATLAB: memory of a child; by hand
  std::size_t child_ratio = 64;         ///< MATLAB: … and more for each byte of the file; by hand
  int child_free_s = 8;                 ///< MATLAB: time of a child, and 1 s more per MB; by hand
  std::uint32_t longest_header = 1024;  ///< ROS 1: bytes of a record header behind damage; by hand
  std::uint64_t free_bytes = 64'000'000;  ///< unpacked size that is always accepted; by hand
  std::uint64_t most_ratio = 256;         ///< unpacked to packed bytes beyond free_bytes; by hand
  std::uint64_t free_messages = 100'000;  ///< of packed chunks, besides one per byte; by hand

  std::size_t recognised_by = 4096;  ///< bytes at the beginning that show the format; by hand
  int zstd_level = 3;                ///< zstd's own default

  // Clocks.
  std::int64_t wrap_margin_ns = 60'000'000'000;  ///< until a sender has begun anew; by hand
  std::int64_t longest_uptime_ns = 100'000'000'000'000'000;  ///< of a sender: 3 years; by hand
  std::int64_t longest_untimed_ns = 5'000'000'000;  ///< wait for a sender's uptime; by hand
  std::int64_t between_logs_ns = 60'000'000'000;    ///< between two logs in a .BIN file; by hand
  double first_datenum = 7.0e5;                     ///< days: year 1916; by hand
  double last_datenum = 8.0e5;                      ///< days: year 2190; by hand
  double first_day = 3.2e4;                         ///< of a spreadsheet: year 1987; by hand
  double last_day = 7.3e4;                          ///< year 2099; by hand
  double longest_day_step = 2e-5;  ///< days per row (1.7 s): slower rows are not days; by hand

  // Noise of a field (Statistics).
  std::size_t kept_differences = 512;  ///< memory of 4 kB per number; by hand
  std::size_t fewest_differences = 8;  ///< for a median; by hand
} kTuning{};

}  // namespace kelpie::bag
