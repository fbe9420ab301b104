// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "format/settings_file.hpp"
#include "kelpie/model/settings.hpp"

namespace kelpie::cli {

/// Prints to stderr the user's settings without effect (ModelSettings::notes): settings of --set,
/// and settings of the file that differ from the preset. A file printed by `kelpie config` gives no
/// notes.
void print_notes(const ModelSettings& settings, const format::SettingsFile& file,
                 const std::vector<std::string>& set, bool scale_given = false);

}  // namespace kelpie::cli
