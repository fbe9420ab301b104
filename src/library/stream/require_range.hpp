// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/setting.hpp"

namespace kelpie {

/// Throws InputError with the name and the range, if the value is outside.
inline void require_range(const std::string& name, double value, const Range& range,
                          const std::string& unit = {}) {
  if (!range.holds(value)) {
    throw InputError(name, number_text(value) + " is out of range; it has to be " + range.text() +
                               (unit.empty() ? "" : " " + unit));
  }
}

}  // namespace kelpie
