// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>

#include <Eigen/Dense>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace kelpie::file {

/// Parses a file. Throws InputError with file, line and the parser's words.
toml::table parse_toml(const std::filesystem::path& file);

/// A table of a TOML file that knows where it stands, so that whatever is wrong with a value is
/// told with file, line and key. Reading is strict: of the right type, of the right shape, finite.
/// Keeps a reference to the table.
class TomlSection {
 public:
  /// Throws InputError on a key that is not in `keys`, with the nearest of them.
  TomlSection(const toml::table& table, std::string file, std::string path,
              const std::vector<std::string>& keys);

  bool has(const std::string& key) const { return table_->contains(key); }

  double number(const std::string& key) const;
  double number(const std::string& key, double otherwise) const;
  std::string text(const std::string& key) const;
  std::uint64_t count(const std::string& key) const;  ///< a whole number, not negative

  /// An array of exactly values.size() numbers.
  void numbers(const std::string& key, std::span<double> values) const;
  template <int size>
  Eigen::Matrix<double, size, 1> vector(const std::string& key) const {
    Eigen::Matrix<double, size, 1> values;
    numbers(key, {values.data(), static_cast<std::size_t>(size)});
    return values;
  }
  /// Either `size` numbers, the diagonal, or `size` rows of `size` numbers.
  template <int size>
  Eigen::Matrix<double, size, size> square(const std::string& key) const {
    Eigen::Matrix<double, size, size, Eigen::RowMajor> values;
    square_numbers(key, {values.data(), static_cast<std::size_t>(size * size)}, size);
    return values;
  }

  TomlSection section(const std::string& key, const std::vector<std::string>& keys) const;
  /// The tables of an array of tables ([[key]]).
  std::vector<TomlSection> sections(const std::string& key,
                                    const std::vector<std::string>& keys) const;

  [[noreturn]] void reject(const std::string& key, const std::string& why) const;

 private:
  std::string path_of(const std::string& key) const;
  const toml::node& at(const std::string& key) const;
  double finite(const toml::node& node, const std::string& key) const;
  void fill(const toml::node& node, const std::string& key, std::span<double> values) const;
  void square_numbers(const std::string& key, std::span<double> values, std::size_t size) const;

  const toml::table* table_;
  std::string file_;
  std::string path_;
};

/// Runs `check`; an InputError of it that names a key of `root` ("phases[1].ramp_s") is thrown on
/// with the file, and the line of the key or, where that isn't written, of what encloses it.
void locate_errors(const toml::table& root, const std::string& file,
                   const std::function<void()>& check);

}  // namespace kelpie::file
