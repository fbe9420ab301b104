// SPDX-License-Identifier: Apache-2.0
#include "bag/message_type.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "bag/message_text.hpp"
#include "bag/tuning.hpp"
#include "file/content.hpp"
#include "file/tuning.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::bag {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kLengthBytes = 4;

struct Primitive {
  std::string_view name;
  FieldKind kind;

  std::uint64_t bytes() const { return is_number(kind) ? bytes_of(kind) : kLengthBytes; }
};

constexpr std::array<Primitive, 14> kPrimitives{{
    {"bool", FieldKind::boolean},
    {"byte", FieldKind::uint8},
    {"char", FieldKind::uint8},
    {"int8", FieldKind::int8},
    {"uint8", FieldKind::uint8},
    {"int16", FieldKind::int16},
    {"uint16", FieldKind::uint16},
    {"int32", FieldKind::int32},
    {"uint32", FieldKind::uint32},
    {"int64", FieldKind::int64},
    {"uint64", FieldKind::uint64},
    {"float32", FieldKind::float32},
    {"float64", FieldKind::float64},
    {"string", FieldKind::string},
}};

std::optional<std::string> content_of(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    return std::nullopt;
  }
  return file::read_content(file, "a .msg file", file::kTuning.configuration_bytes);
}

// Where definitions are looked for, one place after the other.
class Sources {
 public:
  Sources(fs::path folder, const std::string& name, const std::string& text, MessageDialect dialect)
      : folder_(std::move(folder)), dialect_(dialect) {
    if (!text.empty()) {
      sections_ = split_sections(name, text);
    }
  }

  MessageDialect dialect() const { return dialect_; }

  // Parsed once: a type may be held many times over.
  const std::vector<FieldLine>& fields_of(const std::string& short_name) {
    const auto found = parsed_.find(short_name);
    return found != parsed_.end()
               ? found->second
               : parsed_.emplace(short_name, parse_fields(short_name, text_of(short_name)))
                     .first->second;
  }

  std::string text_of(const std::string& short_name) const {
    if (const auto found = sections_.find(short_name); found != sections_.end()) {
      return found->second;
    }
    if (!folder_.empty()) {
      const std::size_t slash = short_name.find('/');
      const fs::path package = short_name.substr(0, slash);
      const fs::path file = short_name.substr(slash + 1) + ".msg";
      for (const fs::path& place : {package / "msg" / file, package / file, file}) {
        if (auto content = content_of(folder_ / place)) {
          return *std::move(content);
        }
      }
    }
    const std::string_view built_in = built_in_definition(short_name, dialect_);
    if (built_in.empty()) {
      throw InputError(short_name,
                       "its definition is neither in the bag nor built in; name a folder that "
                       "holds its .msg file by --msg-dir");
    }
    return std::string(built_in);
  }

 private:
  fs::path folder_;
  MessageDialect dialect_;
  std::map<std::string, std::string> sections_;
  std::map<std::string, std::vector<FieldLine>> parsed_;
};

// Of ROS 1, where they are no types of their own: the types that stand for them.
std::string_view time_type(const std::string& word, MessageDialect dialect) {
  if (dialect == MessageDialect::ros2) {
    return {};
  }
  return word == "time"       ? "builtin_interfaces/Time"
         : word == "duration" ? "builtin_interfaces/Duration"
                              : "";
}

// The short name of the type `word` as used within the type `holder`.
std::string resolved(const std::string& word, const std::string& holder, MessageDialect dialect) {
  if (const std::string_view time = time_type(word, dialect); !time.empty()) {
    return std::string(time);
  }
  if (word.find('/') != std::string::npos) {
    return short_type_name(word);
  }
  return word == "Header" ? "std_msgs/Header"
                          : short_type_name(holder.substr(0, holder.find('/')) + "/" + word);
}

const Primitive* primitive_of(const std::string& name, MessageDialect dialect) {
  static constexpr Primitive kByteOfRos1{"byte", FieldKind::int8};
  if (dialect == MessageDialect::ros1 && name == kByteOfRos1.name) {
    return &kByteOfRos1;
  }
  const auto* const found = std::ranges::find(kPrimitives, name, &Primitive::name);
  return found == kPrimitives.end() ? nullptr : found;
}

std::uint64_t least_bytes_of_all(const Field& field) {
  if (field.shape == FieldShape::sequence) {
    return kLengthBytes;
  }
  // Saturates: sizes multiply from level to level.
  const std::uint64_t count = field.shape == FieldShape::array ? field.size : 1;
  return std::min<std::uint64_t>(field.least_bytes, UINT32_MAX) * count;
}

// Builds the tree of a type from its definitions.
class TreeBuilder {
 public:
  TreeBuilder(Sources& sources, MessageType& type) : sources_(sources), type_(type) {}

  void fill(Field& structure, const std::string& short_name, const std::string& path,
            std::size_t depth) {
    if (depth > kTuning.deepest_type) {
      throw InputError(short_name, "holds itself, or types within types more than 32 deep");
    }
    std::set<std::string_view> names;
    for (const FieldLine& line : sources_.fields_of(short_name)) {
      if (!names.insert(line.name).second) {
        throw InputError(short_name, fmt::format("has two fields {}", line.name));
      }
      structure.fields.push_back(field_of(line, short_name, path, depth));
      structure.least_bytes = std::min<std::uint64_t>(
          UINT32_MAX, structure.least_bytes + least_bytes_of_all(structure.fields.back()));
    }
    // A structure without members is stored as one byte (rosidl's dummy member).
    if (sources_.dialect() == MessageDialect::ros2) {
      structure.least_bytes = std::max<std::uint64_t>(1, structure.least_bytes);
    }
  }

 private:
  Field field_of(const FieldLine& line, const std::string& holder, const std::string& path,
                 std::size_t depth) {
    if (++fields_ > kTuning.most_fields) {
      throw InputError(type_.name, fmt::format("has more than {} fields", kTuning.most_fields));
    }
    check_name_length(holder, line.name);
    if (line.type == "wstring") {
      throw InputError(holder, fmt::format("{} is a wstring, which isn't read", line.name));
    }
    Field field;
    field.name = line.name;
    field.shape = line.shape;
    field.size = line.size;
    field.string_bound = line.string_bound;
    const bool many = line.shape != FieldShape::single;
    const std::string own_path = path + (path.empty() ? "" : ".") + line.name + (many ? "[]" : "");
    if (const Primitive* const primitive = primitive_of(line.type, sources_.dialect())) {
      field.kind = primitive->kind;
      field.least_bytes = primitive->bytes();
      field.leaf = type_.leaves.size();
      type_.leaves.push_back(
          {own_path, field.kind, line.shape == FieldShape::sequence && primitive->bytes() == 1});
    } else {
      fill(field, resolved(line.type, holder, sources_.dialect()), own_path, depth + 1);
    }
    return field;
  }

  Sources& sources_;
  MessageType& type_;
  std::size_t fields_ = 0;
};

// The names of the types that `name` holds, without those in `seen` already.
void collect_types(Sources& sources, const std::string& name, std::vector<std::string>& order,
                   std::set<std::string>& seen) {
  for (const FieldLine& line : sources.fields_of(name)) {
    if (primitive_of(line.type, sources.dialect()) != nullptr ||
        !time_type(line.type, sources.dialect()).empty()) {
      continue;
    }
    const std::string held = resolved(line.type, name, sources.dialect());
    if (seen.insert(held).second) {
      order.push_back(held);
      collect_types(sources, held, order, seen);
    }
  }
}

}  // namespace

std::size_t MessageType::find(const std::string& path) const {
  return static_cast<std::size_t>(std::ranges::find(leaves, path, &Leaf::path) - leaves.begin());
}

void check_name_length(const std::string& type, std::string_view field) {
  if (field.size() > kTuning.longest_name) {
    throw InputError(
        type, fmt::format("has a field whose name is longer than {} bytes", kTuning.longest_name));
  }
}

void add_packed_field(MessageType& type, const std::string& name, FieldKind kind,
                      std::uint32_t count, const std::string& unit, double factor) {
  const bool is_many = count > 1 && is_number(kind);
  type.root.fields.push_back({.name = name,
                              .kind = kind,
                              .shape = is_many ? FieldShape::array : FieldShape::single,
                              .size = count,
                              .leaf = type.leaves.size(),
                              .least_bytes = is_number(kind) ? bytes_of(kind) : count});
  type.root.least_bytes += type.root.fields.back().least_bytes * (is_many ? count : 1);
  type.leaves.push_back(
      {.path = name + (is_many ? "[]" : ""), .kind = kind, .unit = unit, .factor = factor});
}

MessageDefinitions::MessageDefinitions(fs::path folder) : folder_(std::move(folder)) {
  std::error_code error;
  if (!folder_.empty() && !fs::is_directory(folder_, error)) {
    throw InputError({.file = folder_.string()},
                     "is not a folder; --msg-dir names the folder of .msg files");
  }
}

MessageType MessageDefinitions::type(const std::string& name, const std::string& text,
                                     MessageDialect dialect) const {
  MessageType type;
  type.name = name;
  Sources sources(folder_, name, text, dialect);
  TreeBuilder(sources, type).fill(type.root, short_type_name(name), "", 0);
  return type;
}

std::string MessageDefinitions::full_text(const std::string& name, const std::string& text,
                                          MessageDialect dialect) const {
  if (!text.empty()) {
    return text;
  }
  type(name, text, dialect);  // has the checks
  Sources sources(folder_, name, text, dialect);
  std::vector<std::string> order;
  std::set<std::string> seen;
  collect_types(sources, short_type_name(name), order, seen);
  std::string all = sources.text_of(short_type_name(name));
  for (const std::string& held : order) {
    all += fmt::format("{:=<80}\nMSG: {}\n{}", "", held, sources.text_of(held));
    all += all.ends_with('\n') ? "" : "\n";
  }
  return all;
}

}  // namespace kelpie::bag
