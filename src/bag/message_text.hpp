// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "bag/message_type.hpp"

namespace kelpie::bag {

/// A line of a .msg file that declares a field.
struct FieldLine {
  std::string type;  ///< "float64", "Pose" or "geometry_msgs/Pose"
  std::string name;
  FieldShape shape = FieldShape::single;
  std::uint32_t size = Field::kUnbounded;
  std::uint32_t string_bound = Field::kUnbounded;
};

/// The fields of one .msg text; constants, defaults and comments are passed over.
/// Throws InputError (type, line) on a line that is none of these.
std::vector<FieldLine> parse_fields(const std::string& type, std::string_view text);

/// The texts of a definition with "MSG: pkg/Type" sections by their short names; the first is that
/// of `name`.
std::map<std::string, std::string> split_sections(const std::string& name, std::string_view text);

/// "pkg/Type" of "pkg/msg/Type" or "pkg/Type". Throws InputError on anything else: names of types
/// come from files and become paths.
std::string short_type_name(const std::string& name);

/// The definition of a type that is built in, or "".
std::string_view built_in_definition(const std::string& short_name, MessageDialect dialect);

}  // namespace kelpie::bag
