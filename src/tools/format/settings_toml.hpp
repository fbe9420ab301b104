// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "kelpie/model/settings.hpp"

namespace kelpie::format {

/// Settings as TOML, with meaning and allowed values as comments: one value for every axis, or a
/// list with a value per axis. Without `all`: essential settings, and settings that differ from the
/// preset. `--config` reads both forms back to the same settings.
std::string settings_toml(const ModelSettings& settings, bool all);

}  // namespace kelpie::format
