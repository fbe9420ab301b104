// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <map>
#include <string>
#include <vector>

#include "kelpie/alignment/alignment.hpp"
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
void bind_authority(pybind11::module_& module);
void bind_dead_reckoning(pybind11::module_& module);
void bind_alignment(pybind11::module_& module);
void bind_studies(pybind11::module_& module);

/// A dict per command, with `command` and the numbers of Actuator::fields(); or none.
pybind11::list actuators_of(const Alignment& alignment);
/// The actuators of such dicts, where numbers left out are the default. Throws InputError on
/// others.
std::vector<Actuator> actuators_from(const std::vector<pybind11::dict>& given);
void bind_log(pybind11::module_& module);

}  // namespace kelpie::python
