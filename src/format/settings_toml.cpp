// SPDX-License-Identifier: Apache-2.0
#include "format/settings_toml.hpp"

#include <fmt/format.h>

#include <vector>

#include "kelpie/core/text.hpp"

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

std::string settings_toml(const ModelSettings& settings) {
  const auto values = settings.values();
  const std::vector<SettingDoc> docs = setting_docs();
  std::string text =
      "# Settings of kelpie. One value for all targets, or a list with one per target.\n";
  for (std::size_t i = 0; i < values.size(); ++i) {
    text += fmt::format("\n# {} ({})\n{} = {}\n", docs[i].meaning, docs[i].allowed, values[i].first,
                        toml_value(values[i].second));
  }
  return text;
}

}  // namespace kelpie::format
