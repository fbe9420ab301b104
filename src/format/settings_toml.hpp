// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "kelpie/model/settings.hpp"

namespace kelpie::format {

/// All settings as TOML, each with its meaning and what is allowed as a comment: one value for all
/// axes, or a list with one per axis. `--config` reads it back to the same settings.
std::string settings_toml(const ModelSettings& settings);

}  // namespace kelpie::format
