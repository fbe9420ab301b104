// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "wire/scalar.hpp"

namespace kelpie::bag {

using wire::FieldKind;

/// Dialect of .msg texts. ROS 1 has `time` and `duration`, a different std_msgs/Header, a signed
/// `byte`, and stores no byte for an empty structure.
enum class MessageDialect : std::uint8_t { ros2, ros1 };

/// How many elements a field has.
enum class FieldShape : std::uint8_t { single, array, sequence };

/// A field of a message; a structure has fields of its own.
struct Field {
  static constexpr std::uint32_t kUnbounded = UINT32_MAX;

  std::string name{};
  FieldKind kind = FieldKind::structure;
  FieldShape shape = FieldShape::single;
  /// array: length; sequence: longest allowed; characters: number of bytes
  std::uint32_t size = kUnbounded;
  std::uint32_t string_bound = kUnbounded;  ///< string: the most bytes allowed
  std::vector<Field> fields = {};
  std::size_t leaf = 0;           ///< unless a structure: index in MessageType::leaves
  std::uint64_t least_bytes = 0;  ///< least size of an element, without padding
};

/// Layout of a message: a tree of fields with numbers and strings as leaves.
struct MessageType {
  /// A number or string at the end of a path.
  struct Leaf {
    std::string path;  ///< "twist.linear.x"; "points[].x" for all elements
    FieldKind kind = FieldKind::float64;
    bool is_bulk = false;   ///< an element of a sequence of bytes, as in images
    std::string unit = {};  ///< from the definition ("rad/s"); empty: undefined
    double factor = 1.0;    ///< times the stored number: value in this unit
  };

  std::string name;  ///< "nav_msgs/msg/Odometry"
  Field root;        ///< a structure without a name
  std::vector<Leaf> leaves;

  /// The leaf with this path, or leaves.size().
  std::size_t find(const std::string& path) const;
};

/// Throws InputError (type) on a name beyond Tuning::longest_name: every leaf keeps its whole path.
void check_name_length(const std::string& type, std::string_view field);

/// Appends a field to a packed layout: a number, an array of `count` numbers, or a text of `count`
/// bytes.
void add_packed_field(MessageType& type, const std::string& name, FieldKind kind,
                      std::uint32_t count, const std::string& unit = {}, double factor = 1.0);

/// Definitions of message types (https://docs.ros.org/en/humble/Concepts/Basic/About-Interfaces),
/// looked for in the recording, then in a folder, then among the built-in types (std_msgs,
/// geometry_msgs, nav_msgs, sensor_msgs and diagnostic_msgs as far as a vehicle needs).
class MessageDefinitions {
 public:
  /// Looks for pkg/msg/Type.msg, pkg/Type.msg and Type.msg in `folder`; empty: no folder. Throws
  /// InputError for a missing folder.
  explicit MessageDefinitions(std::filesystem::path folder = {});

  /// The layout of the type `name` ("pkg/msg/Type" or "pkg/Type"). `text` is the recording's
  /// definition with "MSG: pkg/Type" sections, or empty. Throws InputError naming type and line: no
  /// definition, a malformed line, wide strings, two fields with the same name, a recursive type,
  /// more than 20,000 fields.
  MessageType type(const std::string& name, const std::string& text = {},
                   MessageDialect dialect = MessageDialect::ros2) const;

  /// The definition of `name` followed by the definitions of the types used, as in MCAP ("ros2msg",
  /// "ros1msg"); `text` itself if not empty. Throws InputError as type() does.
  std::string full_text(const std::string& name, const std::string& text = {},
                        MessageDialect dialect = MessageDialect::ros2) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace kelpie::bag
