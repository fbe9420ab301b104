// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <map>
#include <string>

#include "kelpie/model/settings.hpp"

namespace kelpie::python {

/// Names and values of settings, in the form of ModelSettings::assign().
using SettingTexts = std::map<std::string, std::string>;

/// The settings of a number of axes: a preset with the given values. Throws InputError naming the
/// setting and the fault.
ModelSettings settings_from(const SettingTexts& texts, std::size_t axes);

SettingTexts texts_of(const ModelSettings& settings);

void bind_settings(pybind11::module_& module);
void bind_live_model(pybind11::module_& module);
void bind_trained_model(pybind11::module_& module);
void bind_dead_reckoning(pybind11::module_& module);
void bind_alignment(pybind11::module_& module);
void bind_log(pybind11::module_& module);

}  // namespace kelpie::python
