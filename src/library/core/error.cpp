// SPDX-License-Identifier: Apache-2.0
#include "kelpie/core/error.hpp"

namespace kelpie {
namespace {

// what() ends at the first NUL, and names out of files may begin with one.
std::string with_visible_nuls(const std::string& text) {
  std::string visible;
  for (const char character : text) {
    character == '\0' ? visible += "\\0" : visible += character;
  }
  return visible;
}

std::string locate(const Place& place, const std::string& message) {
  std::string text = place.file;
  if (place.line > 0) {
    text += (text.empty() ? "line " : ":") + std::to_string(place.line);
  }
  if (!place.field.empty()) {
    text += (text.empty() ? "" : ": ") + place.field;
  }
  return with_visible_nuls(text.empty() ? message : text + ": " + message);
}

}  // namespace

InputError::InputError(const Place& place, const std::string& message)
    : std::runtime_error(locate(place, message)), place_(place), message_(message) {}

InputError::InputError(std::string_view field, const std::string& message)
    : InputError(Place{.file = {}, .line = 0, .field = std::string(field)}, message) {}

InputError::InputError(const std::string& message) : InputError(Place{}, message) {}

void require(bool holds, std::string_view field, std::string_view wanted) {
  if (!holds) {
    throw InputError(field, std::string(wanted));
  }
}

void require_size(std::string_view field, std::size_t given, std::size_t wanted) {
  if (given != wanted) {
    throw InputError(field, "has " + std::to_string(given) + " values; it has to have " +
                                std::to_string(wanted));
  }
}

}  // namespace kelpie
