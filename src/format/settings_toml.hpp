// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "kelpie/model/settings.hpp"

namespace kelpie::format {

/// Settings as TOML, each with its meaning and what is allowed as a comment: one value for all
/// axes, or a list with one per axis. Not `all`: the essential ones, and those that differ from the
/// preset. Either way `--config` reads it back to the same settings.
std::string settings_toml(const ModelSettings& settings, bool all);

}  // namespace kelpie::format
