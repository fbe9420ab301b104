// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <map>
#include <string>

#include "kelpie/model/settings.hpp"

namespace kelpie::python {

/// Names and values of settings, as ModelSettings::assign() reads them.
using SettingTexts = std::map<std::string, std::string>;

/// The settings of so many axes: the preset that is named, with the other values set. Throws
/// InputError naming what is wrong with which.
ModelSettings settings_from(const SettingTexts& texts, std::size_t axes);

SettingTexts texts_of(const ModelSettings& settings);

void bind_settings(pybind11::module_& module);
void bind_live_model(pybind11::module_& module);
void bind_trained_model(pybind11::module_& module);
void bind_dead_reckoning(pybind11::module_& module);
void bind_alignment(pybind11::module_& module);
void bind_log(pybind11::module_& module);

}  // namespace kelpie::python
