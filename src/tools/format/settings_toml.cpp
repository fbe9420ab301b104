// SPDX-License-Identifier: Apache-2.0
#include "format/settings_toml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/text.hpp"

namespace kelpie::format {
namespace {

// A value as TOML has it: numbers bare, words in quotes, one per axis in a list.
std::string toml_value(const std::string& text) {
  const std::vector<std::string> parts = split_text(text, ',');
  std::vector<std::string> values;
  for (const std::string& part : parts) {
    double number = 0.0;
    values.push_back(parse_number(part, number) ? part : '"' + part + '"');
  }
  return values.size() == 1 ? values.front() : "[" + join_text(values, ", ") + "]";
}

}  // namespace

std::string settings_toml(const ModelSettings& settings, bool all) {
  const auto start = ModelSettings::from_preset(settings.preset, settings.axes.size()).values();
  const auto values = settings.values();
  std::string text =
      "# Settings of kelpie. One value for all targets, or a list with one per target.\n";
  if (!all) {
    text += "# `kelpie config --all` prints the others too; few users need them.\n";
  }
  for (const SettingSection& section : setting_sections()) {
    std::string lines;
    for (const SettingText& doc : section.settings) {
      const auto value = std::ranges::find(values, doc.name, &decltype(values)::value_type::first);
      if (all || section.title == kEssential || std::ranges::count(start, *value) == 0) {
        lines += fmt::format("\n# {} ({})\n{} = {}\n", doc.meaning, doc.allowed, doc.name,
                             toml_value(value->second));
      }
    }
    text += lines.empty() ? "" : fmt::format("\n# ---- {} ----\n{}", section.title, lines);
  }
  return text;
}

}  // namespace kelpie::format
