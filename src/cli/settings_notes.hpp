// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "format/settings_file.hpp"
#include "kelpie/model/settings.hpp"

namespace kelpie::cli {

/// Says on stderr which settings have no effect (ModelSettings::notes), of those that the user has
/// set: by --set, or in the file to another value than the preset's. So a file that `kelpie config`
/// printed gives no notes.
void print_notes(const ModelSettings& settings, const format::SettingsFile& file,
                 const std::vector<std::string>& set, bool scale_given = false);

}  // namespace kelpie::cli
