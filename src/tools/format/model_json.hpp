// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>

#include "format/learned_logs.hpp"
#include "kelpie/model/trained_model.hpp"

namespace kelpie::format {

/// Units of columns, in the syntax of Unit::parse; for display only.
using ColumnUnits = std::map<std::string, std::string>;

/// A trained model as JSON text (docs/model.md) with its learned logs and the units of its columns,
/// where known. Numbers have the shortest form that reads back to the same value. Ends in a
/// newline.
std::string model_json(const TrainedModel& model, std::span<const LearnedLog> learned = {},
                       const ColumnUnits& units = {});

/// Reads the output of model_json(); predictions are equal to the last bit. Throws InputError
/// (`source`, key) on invalid JSON, another format, a newer version, a missing or extra key,
/// inconsistent sizes, or impossible values.
TrainedModel parse_model_json(const std::string& text, const std::string& source);

/// The units in a model.json; empty without the key. Throws as read_model() does on invalid JSON.
ColumnUnits read_units(const std::filesystem::path& file);

/// Reads a file. Throws InputError also on a missing or unreadable file.
TrainedModel read_model(const std::filesystem::path& file);

}  // namespace kelpie::format
