// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "format/learned_logs.hpp"
#include "kelpie/model/trained_model.hpp"
#include "kelpie/motion/unit.hpp"

namespace kelpie::format {

/// Units of columns, in the syntax of Unit::parse; for display and warnings.
using ColumnUnits = std::map<std::string, std::string>;

ColumnUnits unit_texts(const std::map<std::string, Unit>& units);

/// What a model.json says of the model besides the model itself.
struct ModelInfo {
  ColumnUnits units{};
  std::string doubt{};  ///< what cannot be right in the learned targets; empty: no reason
  std::vector<LearnedLog> learned{};  ///< empty: not known
};

/// A trained model as JSON text (reference/files.md) with what is known of units, doubt and learned
/// logs. Numbers have the shortest form that reads back to the same value. Ends in a newline.
std::string model_json(const TrainedModel& model, const ModelInfo& info = {});

/// Reads the output of model_json(), with `info` where wanted; predictions are equal to the last
/// bit. Throws InputError (`source`, key) on invalid JSON, another format, a newer version, a
/// missing or extra key, inconsistent sizes, or impossible values.
TrainedModel parse_model_json(const std::string& text, const std::string& source,
                              ModelInfo* info = nullptr);

/// Reads a file, once. Throws InputError also on a missing or unreadable file.
TrainedModel read_model(const std::filesystem::path& file, ModelInfo* info = nullptr);

}  // namespace kelpie::format
