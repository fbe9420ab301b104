// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "kelpie/core/error.hpp"

namespace kelpie::vehicle {

/// Throws InputError naming `field` and what is wanted of it, unless `holds`.
inline void require(bool holds, const std::string& field, const std::string& wanted) {
  if (!holds) {
    throw InputError({.file = {}, .line = 0, .field = field}, wanted);
  }
}

}  // namespace kelpie::vehicle
