// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

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

  const std::string& file() const;
  std::size_t line() const;
  const std::string& key() const;  ///< in the enclosing table; "" at the top
  [[noreturn]] void refuse(const std::string& why) const;

  bool is_text() const;
  bool is_table() const;
  std::string text(const std::string& kind = "a text in double quotes") const;
  double number(const std::string& kind = "a finite number") const;  ///< finite
  std::uint64_t count() const;  ///< a whole number, not negative
  bool flag() const;            ///< true or false
  std::vector<std::string> texts(const std::string& kind) const;
  /// A number or text as text, a list separated by commas, as in the assignment of settings.
  std::string setting() const;

  /// The value as JSON with sorted keys: equal values give equal texts.
  std::string canonical() const;

  /// A list of exactly values.size() numbers.
  void numbers(std::span<double> values) const;
  template <int size>
  Eigen::Matrix<double, size, 1> vector() const {
    Eigen::Matrix<double, size, 1> values;
    numbers({values.data(), static_cast<std::size_t>(size)});
    return values;
  }
  /// Either `size` numbers, the diagonal, or `size` rows of `size` numbers.
  template <int size>
  Eigen::Matrix<double, size, size> square() const {
    Eigen::Matrix<double, size, size, Eigen::RowMajor> values;
    square_numbers({values.data(), static_cast<std::size_t>(size * size)}, size);
    return values;
  }

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
  double number_or(const std::string& key, double otherwise) const {
    return has(key) ? (*this)[key].number() : otherwise;
  }

  /// Runs `check`. An InputError about a key below this table ("phases[1].ramp_s") is completed
  /// with the file, and with the line of the key or of the enclosing table.
  void locate_errors(const std::function<void()>& check) const;

 private:
  struct Value;
  explicit TomlNode(std::shared_ptr<const Value> value) : value_(std::move(value)) {}
  void square_numbers(std::span<double> values, std::size_t size) const;

  std::shared_ptr<const Value> value_;
};

}  // namespace kelpie::file
