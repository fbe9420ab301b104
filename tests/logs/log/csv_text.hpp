// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "kelpie/core/error.hpp"
#include "log/dataset.hpp"
#include "support.hpp"

namespace kelpie::testing {

/// A text read as a file "log.csv".
inline log::Table parse_csv(const std::string& text) {
  return log::parse_csv(text, "log.csv");
}

/// Why it is refused.
inline std::string csv_refusal(const std::string& text) {
  return message_of<InputError>([&] { parse_csv(text); });
}

}  // namespace kelpie::testing
