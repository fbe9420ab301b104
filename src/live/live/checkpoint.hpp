// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "kelpie/alignment/alignment.hpp"
#include "kelpie/core/archive.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "live/configuration.hpp"
#include "live/transport.hpp"
#include "log/read_log.hpp"
#include "study/nominal.hpp"

namespace kelpie::live {

/// Times for the learner without long jumps ahead: a step of more than kLongestPause is a clock
/// that was set, and adds nothing. (A DynamicsModel itself copes with jumps back.)
class LearningClock {
 public:
  static constexpr double kLongestPause = log::kTuning.longest_silence_s;  ///< [s]

  double at(double t);           ///< Learning time of the row stamped `t` [s].
  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  double offset_ = 0.0;
  double last_ = 0.0;
  bool has_begun_ = false;
};

/// Progress of a live run: with the model's state, all that a resumed run needs.
struct Progress {
  std::int64_t origin_ns = 0;
  std::int64_t received_ns = 0;  ///< of the last message that completed a row
  log::Reach recording{};        ///< the recording; {}: a connection
  std::size_t rows = 0;          ///< complete rows of this recording
  std::size_t learned = 0;       ///< samples since the model began
  bool is_paused = false;        ///< learning is frozen by request
  std::string doubt{};           ///< why the model is doubtful; empty: no reason
  LearningClock clock{};

  void visit(Archive& archive);  ///< core/archive.hpp
};

/// Content of a checkpoint of a live run.
struct SavedRun {
  Progress progress;
  Alignment alignment;
  std::string model;  ///< DynamicsModel::save()
  std::string file;   ///< path of the checkpoint, for messages
  std::string note;   ///< why the newest file was skipped; or empty
};

/// Writes a checkpoint into the folder, beside the previous one. Throws Failure as
/// format::write_checkpoint does.
void write_checkpoint(const std::filesystem::path& folder, const Configuration& configuration,
                      const SavedRun& run);

/// Reads the newest valid checkpoint of the folder, if there are any files. Throws InputError
/// (file, key, both values) on another configuration, or where no file can be read.
std::optional<SavedRun> find_checkpoint(const std::filesystem::path& folder,
                                        const Configuration& configuration);

/// The saved model, or a fresh model. Throws InputError (file) where the saved model cannot be
/// resumed.
DynamicsModel model_to_begin_with(const Configuration& configuration, const study::Nominal& nominal,
                                  const std::optional<SavedRun>& saved);

/// What LiveSettings::nominal knows of a fresh model, from the disk; empty: nothing. Throws
/// InputError as format::read_model() and study::nominal_of() do.
study::Nominal nominal_of(const Configuration& configuration);

}  // namespace kelpie::live
