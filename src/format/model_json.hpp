// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "format/learned_logs.hpp"
#include "kelpie/model/trained_model.hpp"

namespace kelpie::format {

/// A trained model as text (docs/model.md), numbers in the shortest form that reads back to the
/// same value, with the logs that it learned, where they are known. Ends in a newline.
std::string model_json(const TrainedModel& model, std::span<const LearnedLog> learned = {});

/// Reads what model_json() wrote: predictions are the same to the last bit. Throws InputError
/// (`source`, key) on text that is no JSON, another format, a newer version, a missing or extra
/// key, sizes that don't fit each other, or values that can't be.
TrainedModel parse_model_json(const std::string& text, const std::string& source);

/// The same from a file. Throws InputError on a missing or unreadable one.
TrainedModel read_model(const std::filesystem::path& file);

}  // namespace kelpie::format
