// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <memory>

#include "kelpie/model/online_model.hpp"
#include "log/dataset.hpp"
#include "study/forward_chain.hpp"
#include "study/split.hpp"

namespace kelpie::study {

struct StreamResult;

// Simple predictors that run_stream() takes, which a learned model has to beat.

/// Recursive, robust (residuals clipped at 3 usual errors), nothing forgotten, on physics terms
/// that need no names: x and x|x| of every input, products and squares of velocities, and 1.
/// Velocities are the first inputs: those named so, else as many as there are targets (up to 6).
/// Null where the terms are too many, or a name can't stand in a formula.
std::unique_ptr<OnlineModel> make_least_squares(const log::Dataset& data);

/// One axis of each, for ForwardChain. The first is empty where make_least_squares() is null.
LearnerFactory least_squares_of_one_axis(const log::Dataset& data);
LearnerFactory mean_of_one_axis();

/// Says the mean of the targets so far.
std::unique_ptr<OnlineModel> make_mean(const log::Dataset& data);

/// Says the target one sample ago, which tells nothing of held-out rows.
std::unique_ptr<OnlineModel> make_last_value(const log::Dataset& data);

/// How good a simple predictor is. NaN where R² isn't defined.
struct Baseline {
  double r2_final = std::numeric_limits<double>::quiet_NaN();  ///< held-out rows, at the end
  double prequential_r2 = r2_final;  ///< one step ahead, on the samples that the model predicted
};

/// All of them, on one axis.
struct Baselines {
  Baseline least_squares;
  Baseline mean;
  Baseline last_value;  ///< without r2_final
};

/// Gives every axis of a result its baselines, on the rows by which run_stream() judged it.
/// Requires the data and split of that stream.
void add_baselines(const log::Dataset& data, const Split& split, StreamResult& result);

}  // namespace kelpie::study
