// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "format/run_checkpoint.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/model/trained_model.hpp"

namespace kelpie::format {

/// What a run goes on from: the model of an earlier one, perhaps of another log. A checkpoint holds
/// all of it, a model.json what DynamicsModel::resume_from() can use.
class Origin {
 public:
  /// Throws InputError (file, key) on a file that is neither, or that can't be read.
  explicit Origin(const std::filesystem::path& file);

  const std::string& file() const { return file_; }
  const std::vector<std::string>& inputs() const { return inputs_; }
  const std::vector<std::string>& targets() const { return targets_; }
  const ModelSettings& settings() const { return settings_; }
  const Alignment& alignment() const { return alignment_; }

  /// Whether its scale was given, and so is never followed.
  bool scale_given() const;

  /// A model that has learned nothing yet, and to which a checkpoint of a run from here fits.
  DynamicsModel fresh(const ModelSettings& settings) const;

  /// The model that goes on, from `start_s` [s] on; with a checkpoint its clock goes on as well.
  /// Throws InputError (file) on settings that it can't go on with: other than its own with a
  /// checkpoint, other terms with a model.json.
  DynamicsModel model(const ModelSettings& settings, double start_s) const;

 private:
  std::string file_;
  std::variant<TrainedModel, SavedModel> saved_;
  std::vector<std::string> inputs_;
  std::vector<std::string> targets_;
  ModelSettings settings_;
  Alignment alignment_;
};

}  // namespace kelpie::format
