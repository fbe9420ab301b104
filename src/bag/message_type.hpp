// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "wire/scalar.hpp"

namespace kelpie::bag {

using wire::FieldKind;

/// Whose .msg texts these are. ROS 1 has `time` and `duration`, another std_msgs/Header, a `byte`
/// with a sign, and nothing stands for a structure without members.
enum class MessageDialect : std::uint8_t { ros2, ros1 };

/// How many elements a field has.
enum class FieldShape : std::uint8_t { single, array, sequence };

/// A field of a message, with the fields of its own type where it is a structure.
struct Field {
  static constexpr std::uint32_t kUnbounded = UINT32_MAX;

  std::string name{};
  FieldKind kind = FieldKind::structure;
  FieldShape shape = FieldShape::single;
  /// array: its length; sequence: the longest allowed; characters: their number
  std::uint32_t size = kUnbounded;
  std::uint32_t string_bound = kUnbounded;  ///< string: the most bytes allowed
  std::vector<Field> fields = {};
  std::size_t leaf = 0;           ///< not a structure: its index in MessageType::leaves
  std::uint64_t least_bytes = 0;  ///< that one element takes at least, without padding
};

/// The layout of a message: a tree of fields whose leaves are numbers and strings.
struct MessageType {
  /// A number or string at the end of a path.
  struct Leaf {
    std::string path;  ///< "twist.linear.x"; "points[].x" stands for all elements
    FieldKind kind = FieldKind::float64;
    bool is_bulk = false;   ///< an element of a sequence of bytes, as in images
    std::string unit = {};  ///< as its definition has it ("rad/s"); empty: it has none
    double factor = 1.0;    ///< times what is stored: the number in this unit
  };

  std::string name;  ///< "nav_msgs/msg/Odometry"
  Field root;        ///< a structure without a name
  std::vector<Leaf> leaves;

  /// The leaf of this path, or leaves.size().
  std::size_t find(const std::string& path) const;
};

/// Appends a field to a packed layout: a number, an array of `count` numbers, or a text of `count`
/// bytes.
void add_packed_field(MessageType& type, const std::string& name, FieldKind kind,
                      std::uint32_t count, const std::string& unit = {}, double factor = 1.0);

/// Definitions of message types (https://docs.ros.org/en/humble/Concepts/Basic/About-Interfaces):
/// those a bag brings along, then those in a folder, then the built-in ones (std_msgs,
/// geometry_msgs, nav_msgs, sensor_msgs and diagnostic_msgs as far as a vehicle needs them).
class MessageDefinitions {
 public:
  /// Looks for pkg/msg/Type.msg, pkg/Type.msg and Type.msg in `folder`; empty: no folder.
  /// Throws InputError when there is no such folder.
  explicit MessageDefinitions(std::filesystem::path folder = {});

  /// The layout of the type `name` ("pkg/msg/Type" or "pkg/Type"). `text` is the definition with
  /// its "MSG: pkg/Type" sections that came with the bag, or empty.
  /// Throws InputError naming type and line: no definition, a line that isn't one, wide strings,
  /// two fields of one name, a type that holds itself, more than 20,000 fields.
  MessageType type(const std::string& name, const std::string& text = {},
                   MessageDialect dialect = MessageDialect::ros2) const;

  /// The definition of `name` followed by those of all types it holds, as MCAP wants it
  /// ("ros2msg", "ros1msg"); `text` itself where it isn't empty. Throws InputError as type() does.
  std::string full_text(const std::string& name, const std::string& text = {},
                        MessageDialect dialect = MessageDialect::ros2) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace kelpie::bag
