// SPDX-License-Identifier: Apache-2.0
#include "kelpie/core/error.hpp"

#include "core/text.hpp"

namespace kelpie {
namespace {

// Letters that a message shows.
constexpr std::size_t kMostOfPath = 400;
constexpr std::size_t kMostOfField = 200;

std::string locate(const Place& place, const std::string& message) {
  std::string text = printable(place.file, kMostOfPath);
  if (place.line > 0) {
    text += (text.empty() ? "line " : ":") + std::to_string(place.line);
  }
  if (!place.field.empty()) {
    text += (text.empty() ? "" : ": ") + printable(place.field, kMostOfField);
  }
  return text.empty() ? message : text + ": " + message;
}

}  // namespace

InputError::InputError(const Place& place, const std::string& message)
    : std::runtime_error(locate(place, shortened(message))),
      place_(place),
      message_(shortened(message)) {}

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
