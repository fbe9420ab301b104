// SPDX-License-Identifier: Apache-2.0
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "bindings.hpp"

namespace kelpie::python {

namespace py = pybind11;

ModelSettings settings_from(const SettingTexts& texts, std::size_t axes) {
  const auto preset = texts.find("preset");
  ModelSettings settings =
      ModelSettings::from_preset(preset == texts.end() ? "default" : preset->second, axes);
  for (const auto& [name, text] : texts) {
    if (name != "preset") {
      settings.assign(name, text);
    }
  }
  return settings;
}

SettingTexts texts_of(const ModelSettings& settings) {
  const auto values = settings.values();
  return {values.begin(), values.end()};
}

void bind_settings(py::module_& module) {
  module.def(
      "preset_values",
      [](const std::string& preset, std::size_t axes) {
        return texts_of(settings_from({{"preset", preset}}, axes));
      },
      py::arg("preset"), py::arg("axes"),
      "Every setting of a preset by name, as text: one value, or one per axis separated by "
      "commas.");
  module.def(
      "setting_docs",
      [] {
        py::list list;
        for (const SettingSection& section : setting_sections()) {
          for (const SettingText& doc : section.settings) {
            list.append(py::make_tuple(doc.name, doc.meaning, doc.allowed, section.title));
          }
        }
        return list;
      },
      "Name, meaning, what is allowed and group of every setting, in the order of `kelpie config "
      "--all`.");
}

}  // namespace kelpie::python
