// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/model/stored_past_model.hpp"
#include "log/dataset.hpp"

namespace kelpie::format {

/// The past models of one axis.
struct AxisMemory {
  std::string target;
  std::vector<StoredPastModel> models;

  std::string name_of(const StoredPastModel& model) const;  ///< "target:number"
};

/// The past models of one vehicle, as stored on disk (docs/method/learner.md).
struct PastModelsFile {
  std::vector<std::string> inputs;
  std::map<std::string, std::string> units;  ///< of inputs and targets, where known
  std::vector<std::string> terms{};          ///< of the sums, the constant 1 first
  std::vector<AxisMemory> axes;

  /// The past models of a model of this log, made with these settings. Allocates.
  static PastModelsFile of(const DynamicsModel& model, const log::Dataset& data,
                           const ModelSettings& settings);

  std::size_t size() const;  ///< models of every axis together

  /// Hands the past models to a model before its first sample. Throws InputError (`source`) with
  /// the inputs, target or unit that differ from the log, the terms that differ from
  /// the settings, or the axis with more models than the settings keep; the model is then
  /// unchanged.
  void give_to(DynamicsModel& model, const log::Dataset& data, const ModelSettings& settings,
               const std::string& source) const;

  /// Adds the past models of a run. `run` started from an earlier state of this file, which other
  /// runs may have changed meanwhile. A new model gets a free number; a model with more samples
  /// replaces its earlier state, unless the file has the larger state. Keeps at most `settings`'
  /// number of models per axis: the least recalled model leaves first, then the model last seen
  /// longest ago. Throws InputError (`source`) on past models of another vehicle.
  void add(const PastModelsFile& run, const ModelSettings& settings, const std::string& source);

  /// The model with the name "target:number". Throws InputError (`source`) with the known names.
  StoredPastModel& find(std::string_view name, const std::string& source);

  void forget(std::string_view name, const std::string& source);  ///< Errors as find().
};

/// Past models as JSON text; numbers in the shortest form that reads back to the same value.
std::string memory_json(const PastModelsFile& memory);

/// Reads the output of memory_json(). Throws InputError (`source`, key) on other content.
PastModelsFile parse_memory_json(const std::string& text, const std::string& source);

/// Reads a file. Throws InputError also on a missing or unreadable file.
PastModelsFile read_memory(const std::filesystem::path& file);

}  // namespace kelpie::format
