// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bag/mcap_writer.hpp"
#include "bag/message_type.hpp"
#include "bag/reader.hpp"

namespace kelpie::bag {

/// What copying a bag has come to.
struct McapCopy {
  std::string content;  ///< of the MCAP file
  std::size_t messages = 0;
  std::vector<std::string> undefined;  ///< topics whose type nobody defines: they stay raw
};

/// All messages of a bag as MCAP, in the order they are stored in, each topic with its definition.
/// Throws what reading throws.
McapCopy copy_to_mcap(MessageReader& bag, const MessageDefinitions& definitions,
                      const McapWriter::Settings& settings = {});

}  // namespace kelpie::bag
