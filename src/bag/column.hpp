// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bag/message_type.hpp"

namespace kelpie::bag {

/// A column's name taken apart: "/a:b[2].c" has the topic "/a", the pattern "b[].c" and the
/// indices {2}.
struct ColumnName {
  std::string name;
  std::string topic;
  std::string pattern;
  std::vector<std::uint32_t> indices{};
};

/// Throws InputError (column) when `name` isn't one.
ColumnName parse_column(const std::string& name);

/// The leaf that the column means in its topic's type. Throws InputError (column), with the nearest
/// field, when there is none, and when it is text or no single element.
std::size_t leaf_of(const ColumnName& column, const MessageType& type);

}  // namespace kelpie::bag
