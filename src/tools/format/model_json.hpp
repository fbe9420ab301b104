// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "format/learned_logs.hpp"
#include "kelpie/model/trained_model.hpp"

namespace kelpie::format {

/// A trained model as JSON text (docs/model.md) with its learned logs, where known. Numbers have
/// the shortest form that reads back to the same value. Ends in a newline.
std::string model_json(const TrainedModel& model, std::span<const LearnedLog> learned = {});

/// Reads the output of model_json(); predictions are equal to the last bit. Throws InputError
/// (`source`, key) on invalid JSON, another format, a newer version, a missing or extra key,
/// inconsistent sizes, or impossible values.
TrainedModel parse_model_json(const std::string& text, const std::string& source);

/// Reads a file. Throws InputError also on a missing or unreadable file.
TrainedModel read_model(const std::filesystem::path& file);

}  // namespace kelpie::format
