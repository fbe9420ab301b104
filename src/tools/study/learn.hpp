// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kelpie/alignment/alignment.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/model/settings.hpp"
#include "log/dataset.hpp"
#include "study/result.hpp"
#include "study/split.hpp"
#include "study/stream.hpp"

namespace kelpie::study {

/// One log, ready to be learned: rows split, commands aligned, settings complete.
struct LearnPlan {
  log::Dataset data;  ///< commands by `alignment`
  Split split;
  ModelSettings settings;
  std::vector<std::string> commands{};  ///< the inputs that are commands (find_commands())
  AlignmentResult alignment;
  CurrentResult current{};          ///< with the reason; empty `why`: nobody asked
  std::vector<LagInterval> lags{};  ///< of the actuators, where asked for
  std::uint64_t seed = 1;           ///< of a random split
  std::string from{};     ///< file of the model that the run continues; empty: a new model
  std::string nominal{};  ///< files of what is known beforehand, in words; empty: nothing
  /// Source of the scaling: "first" (samples), "train" (all training rows), or the name of the file
  /// that `given_scales` were read from.
  std::string scales = "first";
  std::vector<AxisScaling> given_scales{};

  std::string scales_text() const;  ///< Source of the scaling in words, as in result.json.
};

/// Splits the rows, settles `terms = auto` by the size of roll and pitch in the training rows
/// (`auto:degrees` beyond angles in radians, `quadratic` beyond angles in degrees; not with
/// `known`, which an earlier model gives), finds the alignment (choose_alignment, unless `known`
/// gives one) and aligns the commands; `with_lags`: with the intervals of lags. `current`: "auto"
/// looks for a current where the log has a heading,
/// takes the current off and the heading out of the inputs, and finds the alignment once more;
/// "none". Throws InputError where the log can't be split or aligned in this way.
LearnPlan plan_learning(log::Dataset data, const SplitSettings& split, ModelSettings settings,
                        const std::string& align,
                        const std::optional<AlignmentResult>& known = std::nullopt,
                        bool with_lags = false, const std::string& current = "none");

/// A new model for the plan's log. Throws InputError, naming the column, where the training rows
/// give no scaling.
DynamicsModel make_model(const LearnPlan& plan);

/// Learns the log: run_stream() with `model`, then the baselines on the same rows. Ensures that
/// every field of the result is filled in. Requires a model of the plan's columns and settings:
/// make_model(), or an earlier model that continues. Throws what run_stream() throws.
StreamResult learn(const LearnPlan& plan, DynamicsModel& model, const StreamOptions& options);

/// Fills in the plan's part of a result: origin, scaling, seed, alignment and settings.
void describe(const LearnPlan& plan, StreamResult& result);

}  // namespace kelpie::study
