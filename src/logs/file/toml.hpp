// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "kelpie/core/error.hpp"

namespace kelpie::file {

/// A value of a TOML file with its place, so that every error names file, line and key
/// ("configurations[1].effectiveness"). Reading is strict: a value of another type or shape is an
/// InputError; `kind` describes the wanted value in the message. A node keeps the whole file in
/// memory; copies are cheap.
class TomlNode {
 public:
  /// The top-level table of a file. Throws InputError (file, line) on an unreadable file and on
  /// malformed TOML.
  static TomlNode read(const std::filesystem::path& file);
  /// The top-level table of a text; messages call the text `file`.
  static TomlNode parse(const std::string& content, const std::string& file);

  Place place() const;             ///< file, line and path from the top
  const std::string& key() const;  ///< in the enclosing table; "" at the top
  [[noreturn]] void refuse(const std::string& why) const;

  enum class Type : std::uint8_t { text, list, table, other };
  Type type() const;
  std::string text(const std::string& kind = "a text in double quotes") const;
  double number(const std::string& kind = "a finite number") const;  ///< within ±1e12
  std::uint64_t count() const;  ///< a whole number, not negative
  bool flag() const;            ///< true or false
  /// A number or text as text, a list separated by commas, as in the assignment of settings.
  std::string setting() const;

  /// The value as JSON with sorted keys: equal values give equal texts.
  std::string canonical() const;

  /// The values of a list, with the path of the list.
  std::vector<TomlNode> items(const std::string& kind) const;

  /// Returns this node. Requires a table with no other keys than `keys`: throws InputError on an
  /// unknown key, with the nearest known key.
  const TomlNode& table(const std::vector<std::string>& keys) const;
  /// The tables of a list, as written under [[key]].
  std::vector<TomlNode> tables(const std::vector<std::string>& keys) const;
  /// All values of a table, in the order of the file.
  std::vector<TomlNode> members(const std::string& kind = "a table") const;

  // Of a table:
  bool has(const std::string& key) const;
  TomlNode operator[](const std::string& key) const;  ///< Throws InputError on a missing key.
  /// Runs `check`. An InputError about a key below this table ("phases[1].ramp_s") is completed
  /// with the file, and with the line of the key or of the enclosing table.
  void locate_errors(const std::function<void()>& check) const;

 private:
  struct Value;
  explicit TomlNode(std::shared_ptr<const Value> value) : value_(std::move(value)) {}

  std::shared_ptr<const Value> value_;
};

/// Returns what `read` returns; an InputError of `read` is told with the place of `value`.
template <typename Read>
auto located(const TomlNode& value, const Read& read) {
  try {
    return read();
  } catch (const InputError& error) {
    value.refuse(error.what());
  }
}

/// The texts of a list, at least one.
std::vector<std::string> texts_of(const TomlNode& list, const std::string& kind);

/// Reads a list of exactly values.size() numbers.
void read_numbers(const TomlNode& list, std::span<double> values);

}  // namespace kelpie::file
