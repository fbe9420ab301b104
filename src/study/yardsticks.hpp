// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <span>

#include "log/dataset.hpp"
#include "study/split.hpp"

namespace kelpie::study {

struct StreamResult;

/// How good a simple predictor is. NaN where R² isn't defined.
struct Yardstick {
  double r2_final = std::numeric_limits<double>::quiet_NaN();  ///< held-out rows, at the end
  double prequential_r2 = r2_final;  ///< one step ahead, on the samples that the model predicted
};

/// What a learned model has to beat.
struct Yardsticks {
  /// Recursive, on Fossen's terms of the velocities and 1, residuals clipped at 3 usual errors,
  /// nothing forgotten. Velocities are the first inputs: those named so, else as many as there are
  /// targets (up to 6). NaN where the terms are too many.
  Yardstick least_squares;
  Yardstick mean;        ///< of the targets so far
  Yardstick last_value;  ///< the target one sample ago, which says nothing of held-out rows
};

/// What an axis is measured by.
struct YardstickRun {
  std::size_t axis = 0;
  std::size_t shown = 0;                  ///< training samples shown
  std::span<const std::size_t> samples;   ///< those predicted one step ahead, counted from 1
  std::span<const std::size_t> held_out;  ///< rows of r2_final
};

/// All of them on the training rows shown, in their order.
Yardsticks yardsticks_of(const log::Dataset& data, const Split& split, const YardstickRun& run);

/// Gives every axis of a result its yardsticks, on the rows by which run_stream() judged it.
/// Requires the data and split of that stream.
void add_yardsticks(const log::Dataset& data, const Split& split, StreamResult& result);

}  // namespace kelpie::study
