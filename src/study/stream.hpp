// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kelpie/online/regressor.hpp"
#include "log/dataset.hpp"
#include "study/result.hpp"
#include "study/split.hpp"

namespace kelpie::study {

/// How a stream is run and watched.
struct StreamOptions {
  /// Training samples between two looks at the held-out rows; 0: such that there are 200 looks.
  std::size_t validate_every = 0;
  /// Further looks, after so many samples; in ascending order.
  std::vector<std::size_t> also_at{};
  /// Called after every sample with the number shown so far; false stops the stream there.
  std::function<bool(std::size_t)> keep_going = [](std::size_t) { return true; };
  /// Training samples between two calls of `save`; 0: none. It is called also where the stream is
  /// stopped and at its end, with the samples shown and all that the stream has found until then;
  /// the learners' own state is the caller's to save.
  std::size_t save_every = 0;
  std::function<void(std::size_t, const std::string&)> save{};
  /// What `save` was given, to go on from there. Requires the same data, split and options as then,
  /// and the learners as they were. Empty: from the start.
  std::string_view resume{};
};

/// The paper's evaluation: the training rows of `split` are shown to the learners in the order of
/// time, one learner per target, and after every `validate_every`-th each is judged on the held-out
/// rows of the configuration that is then running. Learners see raw units (model/scaled.hpp).
/// Requires as many learners as targets. Throws InputError on a `resume` that doesn't fit.
/// Ensures: everything but rows_*, scales, seed and settings of the result is filled in, also when
/// the stream was stopped early.
StreamResult run_stream(const log::Dataset& data, const Split& split,
                        std::span<OnlineRegressor* const> learners, const StreamOptions& options);

}  // namespace kelpie::study
