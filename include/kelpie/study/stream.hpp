// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "kelpie/data/dataset.hpp"
#include "kelpie/data/split.hpp"
#include "kelpie/online/regressor.hpp"
#include "kelpie/study/result.hpp"

namespace kelpie {

/// How a stream is run and watched.
struct StreamOptions {
  /// Training samples between two looks at the held-out rows; 0: such that there are 200 looks.
  std::size_t validate_every = 0;
  /// Further looks, after so many samples; in ascending order.
  std::vector<std::size_t> also_at{};
  /// Called after every sample with the number shown so far; false stops the stream there.
  std::function<bool(std::size_t)> keep_going = [](std::size_t) { return true; };
};

/// The paper's evaluation: the training rows of `split` are shown to the learners in the order of
/// time, one learner per target, and after every `validate_every`-th each is judged on the held-out
/// rows of the configuration that is then running. Learners see raw units (model/scaled.hpp).
/// Requires as many learners as targets.
/// Ensures: everything but rows_*, scales, seed and settings of the result is filled in, also when
/// the stream was stopped early.
StreamResult run_stream(const Dataset& data, const Split& split,
                        std::span<OnlineRegressor* const> learners, const StreamOptions& options);

}  // namespace kelpie
