// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

namespace kelpie {

/// Where in the user's input something is wrong. Parts that don't apply stay empty (line: 0).
struct Place {
  std::string file;
  std::size_t line = 0;  ///< counted from 1
  std::string field;     ///< column, key or option
};

/// The user's input is wrong: the message names the place and says what would be right.
/// Commands end with exit code 2.
class InputError : public std::runtime_error {
 public:
  /// The text reads "file:line: field: message", without the parts that don't apply.
  InputError(const Place& place, const std::string& message);
  InputError(std::string_view field, const std::string& message);  ///< No file is concerned.
  explicit InputError(const std::string& message);                 ///< Without a place.

  const Place& place() const { return place_; }

 private:
  Place place_;
};

/// Throws InputError about `field`, saying what is `wanted` of it, unless `holds`.
void require(bool holds, std::string_view field, std::string_view wanted);

/// Throws InputError about `field` unless it has as many values as wanted.
void require_size(std::string_view field, std::size_t given, std::size_t wanted);

/// Something failed that is not the input's fault (a full disk, a lost device). Exit code 1.
class Failure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace kelpie
