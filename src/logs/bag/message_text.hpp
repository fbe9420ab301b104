// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "bag/message_type.hpp"

namespace kelpie::bag {

/// Whether a word can be the name of a field: a letter, then letters, digits and underscores.
bool is_identifier(std::string_view word);

/// A line of a .msg file with a field.
struct FieldLine {
  std::string type;  ///< "float64", "Pose" or "geometry_msgs/Pose"
  std::string name;
  FieldShape shape = FieldShape::single;
  std::uint32_t size = Field::kUnbounded;
  std::uint32_t string_bound = Field::kUnbounded;
};

/// The fields of a .msg text; constants, defaults and comments are skipped. Throws InputError
/// (type, line) on any other line.
std::vector<FieldLine> parse_fields(const std::string& type, std::string_view text);

/// Splits a definition with "MSG: pkg/Type" sections by short type name; the first section defines
/// `name`.
std::map<std::string, std::string> split_sections(const std::string& name, std::string_view text);

/// "pkg/Type" of "pkg/msg/Type" or "pkg/Type". Throws InputError on anything else: names of types
/// come from files and become paths.
std::string short_type_name(const std::string& name);

/// The definition of a built-in type, or "".
std::string_view built_in_definition(const std::string& short_name, MessageDialect dialect);

}  // namespace kelpie::bag
