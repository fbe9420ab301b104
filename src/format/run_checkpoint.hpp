// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "format/checkpoint_file.hpp"
#include "kelpie/model/alignment.hpp"
#include "kelpie/model/settings.hpp"
#include "log/dataset.hpp"
#include "study/split.hpp"

namespace kelpie::format {

/// What a run is: a log, a split, settings. Only the same run can be resumed.
struct RunIdentity {
  /// Names and values, in the order they are compared in.
  using Fields = std::vector<std::pair<std::string, std::string>>;

  std::string kelpie;  ///< version; for people
  std::string source;  ///< the log's path; for people: a log may move
  Fields units;        ///< of columns; for people
  Fields run;          ///< rows, times and checksum of the log, columns, split, seed, …
  Fields settings;     ///< as ModelSettings::values()
  std::vector<std::string> inputs;   ///< for who goes on with the model under another log
  std::vector<std::string> targets;  ///< likewise
  Alignment alignment;               ///< of the log's commands; likewise
  bool scale_given = false;          ///< and so it is never followed; likewise
};

/// What the caller knows of a run besides data and settings.
struct RunOptions {
  std::string kelpie;
  std::uint64_t seed = 0;
  std::string scales;
  bool scale_given = false;
  std::string align;      ///< as the user gave it
  Alignment alignment{};  ///< what came of it
  std::string from{};     ///< the file it goes on from; empty: it begins anew
  std::size_t validate_every = 0;
};

/// Of a run that is about to begin.
RunIdentity identify_run(const log::Dataset& data, const study::Split& split,
                         const ModelSettings& settings, const RunOptions& options);

/// How far a run has come.
struct RunState {
  std::size_t samples_shown = 0;
  std::string model;   ///< DynamicsModel::save()
  std::string stream;  ///< as StreamOptions::save was given it
  std::string file;    ///< where it was read from; for messages
};

/// What unpack_run() takes apart again.
Checkpoint pack_run(const RunIdentity& identity, const RunState& state);

/// Throws InputError naming the file and the field, with both values, where the checkpoint is of
/// another run; or the file where its header isn't one of ours.
RunState unpack_run(const FoundCheckpoint& found, const RunIdentity& identity);

/// The model in a checkpoint, with all that its constructor wants to know.
struct SavedModel {
  std::vector<std::string> inputs{};
  std::vector<std::string> targets{};
  ModelSettings settings{};
  Alignment alignment{};
  bool scale_given = false;
  std::string state;  ///< DynamicsModel::save()
};

/// Throws InputError naming the file, and the key, where its header isn't one of ours.
SavedModel saved_model(const FoundCheckpoint& found);

}  // namespace kelpie::format
