// SPDX-License-Identifier: Apache-2.0
#include "cli/settings_notes.hpp"
#include "cli/output.hpp"

#include <algorithm>
#include <cstdio>

namespace kelpie::cli {

void print_notes(const ModelSettings& settings, const format::SettingsFile& file,
                 const std::vector<std::string>& set, bool scale_given) {
  const auto start = ModelSettings::from_preset(settings.preset, settings.axes.size()).values();
  std::vector<std::string> names;
  for (const auto& value : settings.values()) {
    if (file.settings.contains(value.first) && std::ranges::count(start, value) == 0) {
      names.push_back(value.first);
    }
  }
  for (const std::string& assignment : set) {
    names.push_back(format::key_and_value(assignment).first);
  }
  for (const std::string& note : settings.notes(names, scale_given)) {
    warn("kelpie: {}\n", note);
  }
}

}  // namespace kelpie::cli
