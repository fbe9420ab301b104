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

/// The past models of one vehicle, as they are kept on disk (docs/memory.md).
struct PastModelsFile {
  std::vector<std::string> inputs;
  std::map<std::string, std::string> units;  ///< of inputs and targets, where they are known
  std::vector<AxisMemory> axes;

  /// What a model remembers that learns this log. Allocates.
  static PastModelsFile of(const DynamicsModel& model, const log::Dataset& data);

  std::size_t size() const;  ///< models of all axes

  /// Gives a model that has learned nothing yet what it is to remember. Throws InputError
  /// (`source`) naming the inputs, the target or the unit that differ from the log's, or the axis
  /// with more models than the settings keep; then nothing has been given.
  void give_to(DynamicsModel& model, const log::Dataset& data, const ModelSettings& settings,
               const std::string& source) const;

  /// Adds what a run has learned. `run` is its memory at the end, a memory that began with an
  /// earlier state of this one; others may have changed it meanwhile. Models that are new get a
  /// number that is free; one that has grown takes its own place, unless it has grown more here.
  /// Keeps as many models of an axis as `settings` say: the least recalled leave first, among
  /// them those last seen longest ago. Throws InputError (`source`) on another vehicle's memory.
  void add(const PastModelsFile& run, const ModelSettings& settings, const std::string& source);

  /// The model called "target:number". Throws InputError (`source`) naming those there are.
  StoredPastModel& find(std::string_view name, const std::string& source);

  void forget(std::string_view name, const std::string& source);  ///< Errors as find().
};

/// A memory as text, numbers in the shortest form that reads back to the same value.
std::string memory_json(const PastModelsFile& memory);

/// Reads what memory_json() wrote. Throws InputError (`source`, key) on what doesn't fit.
PastModelsFile parse_memory_json(const std::string& text, const std::string& source);

/// The same from a file. Throws InputError on a missing or unreadable one.
PastModelsFile read_memory(const std::filesystem::path& file);

}  // namespace kelpie::format
