// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "cli/log_options.hpp"
#include "format/origin.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "log/dataset.hpp"
#include "study/split.hpp"

namespace kelpie::cli {

/// What `kelpie learn` is told.
struct LearnArguments {
  LogOptions log;
  std::vector<std::string> more;
  std::string from;
  std::string config;
  std::vector<std::string> set;
  std::vector<std::string> units;
  std::string split = "auto";
  std::uint64_t seed = 1;
  std::string scales = "first";
  std::string align = "auto";
  std::size_t validate_every = 0;
  std::size_t checkpoint_every = 0;
  bool resume = false;
  std::string memory;
  std::string out = "out/learn";
};

// What a run begins with.

/// Throws InputError where two options both say what a run begins with.
void require_one_start(const LearnArguments& options);

/// All files that are read; --memory, which is written as well, is the last.
std::vector<std::string> files_read(const LearnArguments& options);

/// A model that has learned nothing of this log; `from`: that of an earlier run, or null. Throws
/// InputError where the log can give no scale, and what reading files throws.
DynamicsModel make_model(const LearnArguments& options, const format::Origin* from,
                         const log::Dataset& data, const study::Split& split,
                         const ModelSettings& settings);

/// Gives it the past models of --memory. A file that isn't there is a memory that is empty.
void give_memory(const LearnArguments& options, const log::Dataset& data,
                 const ModelSettings& settings, DynamicsModel& model);

/// All logs that the model will have learned, in this run (`now`) and before; none where that isn't
/// known (--from a file that doesn't tell, a --memory with past models), or no row is held out.
std::vector<format::LearnedLog> all_learned(const LearnArguments& options,
                                            const std::vector<format::LearnedLog>& now);

/// Where the scale comes from, in words.
std::string scales_text(const LearnArguments& options, const ModelSettings& settings);

}  // namespace kelpie::cli
