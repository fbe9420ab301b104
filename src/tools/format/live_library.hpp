// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "format/model_c.hpp"
#include "kelpie/model/trained_model.hpp"

namespace kelpie::format {

/// Files of `kelpie export --live` beside a library vehicle.so: vehicle.block and vehicle.c.
struct LiveFiles {
  std::filesystem::path library;
  std::filesystem::path block;
  std::filesystem::path source;

  explicit LiveFiles(std::filesystem::path library_file);
};

/// The room that every later state of the model may need, with the model's settings. `assess`:
/// interval and novelty, too. Allocates a learner.
BlockLayout live_layout(const TrainedModel& model, bool assess);

/// Writes the three files: the block, whose first publication is the model; the C source, with the
/// functions for CasADi, by which the block is opened at its absolute path; and the source compiled
/// by the machine's C compiler ($CC, else cc), whose messages go to the standard error stream.
/// Programs that have the files open keep the old ones. Throws InputError as model_c() does, and
/// where a learner renews the old block; Failure where there is no compiler or a file can't be
/// written.
void write_live_library(const LiveFiles& files, const TrainedModel& model, CodeOptions options);

}  // namespace kelpie::format
