// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "kelpie/core/archive.hpp"
#include "kelpie/model/alignment.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "live/configuration.hpp"
#include "live/transport.hpp"
#include "log/signal.hpp"

namespace kelpie::live {

/// A time that the learner can bear: stamps that jump ahead by more than kLongestPause are of a
/// clock that was set, and go on from where they were. (A DynamicsModel itself bears those that
/// jump back.)
class LearningClock {
 public:
  static constexpr double kLongestPause = log::kLongestSilenceS;  ///< [s]

  double at(double t);           ///< The time to learn the row stamped `t` [s] at.
  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  double offset_ = 0.0;
  double last_ = 0.0;
  bool has_begun_ = false;
};

/// How far a live run has come; with the model's own state, all that going on takes.
struct Progress {
  std::int64_t origin_ns = 0;
  std::int64_t received_ns = 0;  ///< of the last message that made a row
  log::Reach recording{};        ///< which one it is of; {}: of none
  std::size_t rows = 0;          ///< whole rows, since the beginning of that recording
  std::size_t learned = 0;       ///< samples, ever
  bool is_paused = false;        ///< nothing is learned, as somebody asked
  LearningClock clock{};

  void visit(Archive& archive);  ///< core/archive.hpp
};

/// What a checkpoint of a live run holds.
struct SavedRun {
  Progress progress;
  Alignment alignment;
  std::string model;  ///< DynamicsModel::save()
  std::string file;   ///< where it was found; for messages
  std::string note;   ///< that the newest couldn't be read, and why; or empty
};

/// Writes it into the folder; the one before stays beside it. Throws Failure as
/// format::write_checkpoint does.
void write_checkpoint(const std::filesystem::path& folder, const Configuration& configuration,
                      const SavedRun& run);

/// The newest in the folder that can be read, or nothing. Throws InputError (file, key, with both
/// values) where it is of another configuration, or none can be read.
std::optional<SavedRun> find_checkpoint(const std::filesystem::path& folder,
                                        const Configuration& configuration);

/// The model that was saved, or a fresh one. Throws InputError (file) where it can't be gone on
/// with.
DynamicsModel model_to_begin_with(const Configuration& configuration,
                                  const std::optional<SavedRun>& saved);

}  // namespace kelpie::live
