// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "bag/mcap_records.hpp"

namespace kelpie::bag {

/// What the end of an MCAP file tells of the rest.
struct McapSummary {
  std::vector<Record> definitions;           ///< schemas before the channels that use them
  std::vector<std::uint64_t> chunk_offsets;  ///< ascending
  std::optional<std::uint64_t> messages;     ///< in the whole file
};

bool has_mcap_magic(std::span<const std::byte> bytes);

/// Empty where a file ends properly but has no summary. Throws InputError (file, offset) when it
/// doesn't end as MCAP, or its footer or summary is damaged.
McapSummary read_mcap_summary(std::span<const std::byte> bytes, const Region& region);

}  // namespace kelpie::bag
