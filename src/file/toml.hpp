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

/// A value of a TOML file that knows where it stands, so that whatever is wrong with it is told
/// with file, line and key ("configurations[1].effectiveness"). Reading is strict: what is not of
/// the type and shape asked for is an InputError; `kind` is what its message says the value has to
/// be. A node keeps the whole file in memory; copies are cheap.
class TomlNode {
 public:
  /// The top-level table of a file. Throws InputError (file, line) when it can't be read or isn't
  /// TOML.
  static TomlNode read(const std::filesystem::path& file);
  /// The same of a text; `file` is what messages call it.
  static TomlNode parse(const std::string& content, const std::string& file);

  const std::string& file() const;
  std::size_t line() const;
  const std::string& key() const;  ///< in the table it stands in; "" at the top
  [[noreturn]] void refuse(const std::string& why) const;

  bool is_text() const;
  bool is_table() const;
  std::string text(const std::string& kind = "a text in double quotes") const;
  double number(const std::string& kind = "a finite number") const;  ///< finite
  std::uint64_t count() const;  ///< a whole number, not negative
  bool flag() const;            ///< true or false
  std::vector<std::string> texts(const std::string& kind) const;
  /// A number or text as text, a list of them separated by commas: as settings are assigned.
  std::string setting() const;

  /// The value as JSON, keys in alphabetical order: values that say the same have the same.
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

  /// This node, which has to be a table with no other keys than these: an unknown one is refused
  /// with the nearest of them.
  const TomlNode& table(const std::vector<std::string>& keys) const;
  /// The tables of a list, as written under [[key]].
  std::vector<TomlNode> tables(const std::vector<std::string>& keys) const;
  /// All values of a table, in the order in which the file has them.
  std::vector<TomlNode> members(const std::string& kind = "a table") const;

  // Of a table:
  bool has(const std::string& key) const;
  TomlNode operator[](const std::string& key) const;  ///< Throws InputError when it is missing.
  double number_or(const std::string& key, double otherwise) const {
    return has(key) ? (*this)[key].number() : otherwise;
  }

  /// Runs `check`; an InputError of it that names a key below this table ("phases[1].ramp_s") is
  /// thrown on with the file, and the line of the key or, where that isn't written, of what
  /// encloses it.
  void locate_errors(const std::function<void()>& check) const;

 private:
  struct Value;
  explicit TomlNode(std::shared_ptr<const Value> value) : value_(std::move(value)) {}
  void square_numbers(std::span<double> values, std::size_t size) const;

  std::shared_ptr<const Value> value_;
};

}  // namespace kelpie::file
