// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "format/checkpoint_file.hpp"
#include "kelpie/alignment/alignment.hpp"
#include "kelpie/model/settings.hpp"
#include "log/dataset.hpp"
#include "study/split.hpp"

namespace kelpie::format {

/// The identity of a run: log, split and settings. Only the same run can be resumed.
struct RunIdentity {
  /// Names and values, in the order of comparison.
  using Fields = std::vector<std::pair<std::string, std::string>>;

  std::string kelpie;  ///< version; for people
  std::string source;  ///< path of the log; for people: a log may move
  Fields units;        ///< of columns; for people
  Fields run;          ///< rows, times and checksum of the log, columns, split, seed, …
  Fields settings;     ///< as ModelSettings::values()
  std::vector<std::string> inputs;   ///< for continuation with another log
  std::vector<std::string> targets;  ///< likewise
  Alignment alignment;               ///< of the commands of the log; likewise
  bool scale_given = false;          ///< the scale is fixed; likewise
};

/// The options of a run besides data and settings.
struct RunOptions {
  std::string kelpie;
  std::uint64_t seed = 0;
  std::string scales;
  bool scale_given = false;
  std::string align;      ///< as the user gave it
  Alignment alignment{};  ///< the resulting alignment
  std::string from{};     ///< file of the earlier model; empty: a new model
  std::string nominal{};  ///< files of what was known beforehand; empty: nothing
  std::size_t validate_every = 0;
};

/// The identity of a run before its start.
RunIdentity identify_run(const log::Dataset& data, const study::Split& split,
                         const ModelSettings& settings, const RunOptions& options);

/// The state of a run.
struct RunState {
  std::size_t samples_shown = 0;
  std::string model;   ///< DynamicsModel::save()
  std::string stream;  ///< the state handed to StreamOptions::save
  std::string file;    ///< source file, for messages
};

/// The checkpoint of a run; unpack_run() is the inverse.
Checkpoint pack_run(const RunIdentity& identity, const RunState& state);

/// Throws InputError with file, field and both values for the checkpoint of another run, and with
/// the file for a header of another format.
RunState unpack_run(const FoundCheckpoint& found, const RunIdentity& identity);

/// The model in a checkpoint, with the arguments of its constructor.
struct SavedModel {
  std::vector<std::string> inputs{};
  std::vector<std::string> targets{};
  ModelSettings settings{};
  Alignment alignment{};
  bool scale_given = false;
  std::string state;  ///< DynamicsModel::save()
};

/// Throws InputError with file and key for a header of another format.
SavedModel saved_model(const FoundCheckpoint& found);

}  // namespace kelpie::format
