// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "format/learned_logs.hpp"
#include "format/run_checkpoint.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/model/trained_model.hpp"

namespace kelpie::format {

/// The model of an earlier run, perhaps of another log, from which a run continues. A checkpoint
/// holds the complete state, a model.json the part used by DynamicsModel::resume_from().
class Origin {
 public:
  /// Throws InputError (file, key) on an unreadable file and on other formats.
  explicit Origin(const std::filesystem::path& file);

  const std::string& file() const { return file_; }
  const std::vector<std::string>& inputs() const { return inputs_; }
  const std::vector<std::string>& targets() const { return targets_; }
  const ModelSettings& settings() const { return settings_; }
  const Alignment& alignment() const { return alignment_; }
  /// The learned logs that a model.json names; empty: not known.
  const std::vector<LearnedLog>& learned() const { return learned_; }

  /// Whether the scale was given, and is therefore fixed.
  bool scale_given() const;

  /// An untrained model that accepts the checkpoint of a run with this origin.
  DynamicsModel fresh(const ModelSettings& settings) const;

  /// The continued model, from `start_s` [s] on; a checkpoint continues the clock, too. Throws
  /// InputError (file) on incompatible settings: any difference with a checkpoint, other terms with
  /// a model.json.
  DynamicsModel model(const ModelSettings& settings, double start_s) const;

 private:
  std::string file_;
  std::vector<LearnedLog> learned_;
  std::variant<TrainedModel, SavedModel> saved_;
  std::vector<std::string> inputs_;
  std::vector<std::string> targets_;
  ModelSettings settings_;
  Alignment alignment_;
};

}  // namespace kelpie::format
