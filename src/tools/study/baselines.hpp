// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "kelpie/model/online_model.hpp"
#include "log/dataset.hpp"
#include "study/forward_chain.hpp"
#include "study/split.hpp"

namespace kelpie::study {

struct StreamResult;

// Simple predictors for run_stream(). A learned model has to beat them.

/// Recursive least squares, robust (residuals clipped at 3 usual errors), without forgetting. Terms
/// need no names: x and x|x| of every input, products and squares of velocities, and 1. Velocities
/// are the first inputs: the inputs with a velocity's name, else as many as targets (up to 6). Null
/// with too many terms, or with a name that no formula can hold.
std::unique_ptr<OnlineModel> make_least_squares(const log::Dataset& data);

/// One axis for a ForwardChain. The first is empty where make_least_squares() is null.
LearnerFactory least_squares_of_one_axis(const log::Dataset& data);
LearnerFactory mean_of_one_axis();

/// Predicts the mean of all targets so far.
std::unique_ptr<OnlineModel> make_mean(const log::Dataset& data);

/// Predicts the target one sample ago; not defined on held-out rows.
std::unique_ptr<OnlineModel> make_last_value(const log::Dataset& data);

/// Scores of a simple predictor. NaN where R² isn't defined.
struct Baseline {
  double r2_final = std::numeric_limits<double>::quiet_NaN();  ///< held-out rows, at the end
  double prequential_r2 = r2_final;  ///< one step ahead, on the samples that the model predicted
};

/// Scores of the simple predictors on one axis.
struct Baselines {
  Baseline least_squares;
  /// Least squares on velocities and attitude alone: what the motion says without the commands.
  /// NaN where no input is known to be a command, or all are.
  Baseline without_commands;
  Baseline mean;
  Baseline last_value;  ///< without r2_final
};

/// The log without these inputs.
log::Dataset without_inputs(log::Dataset data, const std::vector<std::string>& left_out);

/// Adds the baselines to every axis of a result, on the rows that run_stream() used. `commands`:
/// the inputs that are commands. Requires the data and split of that stream.
void add_baselines(const log::Dataset& data, const Split& split,
                   const std::vector<std::string>& commands, StreamResult& result);

}  // namespace kelpie::study
