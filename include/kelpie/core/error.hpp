// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

namespace kelpie {

/// The place of a fault in the user's input. Parts that don't apply are empty (line: 0).
struct Place {
  std::string file{};
  std::size_t line = 0;  ///< counted from 1
  std::string field{};   ///< column, key or option
};

/// A fault in the user's input: the message names the place and a valid input. Commands end with
/// exit code 2.
class InputError : public std::runtime_error {
 public:
  /// The text reads "file:line: field: message", without the parts that don't apply. Parts that are
  /// longer than a message can show are cut.
  InputError(const Place& place, const std::string& message);
  InputError(std::string_view field, const std::string& message);  ///< Without a file.
  explicit InputError(const std::string& message);                 ///< Without a place.

  const Place& place() const { return place_; }
  const std::string& message() const { return message_; }  ///< The text without the place.

 private:
  Place place_;
  std::string message_;
};

/// Calls `work`. An InputError of `work` that names no file is thrown again with `file`.
template <typename Work>
auto in_file(const std::string& file, const Work& work) {
  try {
    return work();
  } catch (const InputError& error) {
    if (!error.place().file.empty()) {
      throw;
    }
    Place place = error.place();
    place.file = file;
    throw InputError(place, error.message());
  }
}

/// Throws InputError "`field`: `wanted`" unless `holds`.
void require(bool holds, std::string_view field, std::string_view wanted);

/// Throws InputError about `field` unless `given` equals `wanted`, in values.
void require_size(std::string_view field, std::size_t given, std::size_t wanted);

/// A failure without a fault in the input (a full disk, a lost device). Exit code 1.
class Failure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace kelpie
