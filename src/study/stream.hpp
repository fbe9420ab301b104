// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kelpie/model/online_model.hpp"
#include "log/dataset.hpp"
#include "study/result.hpp"
#include "study/split.hpp"

namespace kelpie::study {

/// How a stream is run and watched.
struct StreamOptions {
  /// Training samples between two validation points; 0: as many as give 200 points.
  std::size_t validate_every = 0;
  /// Further validation points, after so many samples; in ascending order.
  std::vector<std::size_t> also_at{};
  /// Called after every sample with the number shown so far; false stops the stream there.
  std::function<bool(std::size_t)> keep_going = [](std::size_t) { return true; };
  /// Training samples between two calls of `save`; 0: none. It is called also where the stream is
  /// stopped and at its end, with the samples shown and all that the stream has found until then.
  /// The model's own state is the caller's to save.
  std::size_t save_every = 0;
  std::function<void(std::size_t, const std::string&)> save{};
  /// What `save` was given, to go on from there. Requires the same data, split and options as then,
  /// and the model as it was. Empty: from the start.
  std::string_view resume{};
};

/// The paper's evaluation: the model learns the training rows of `split` in the order of time, in
/// the units of the log, and after every `validate_every`-th its axes are judged on the held-out
/// rows of the configuration that is then running. Requires an axis per target. Throws InputError
/// on a `resume` that doesn't fit. Ensures: the result has all of the stream, also when it was
/// stopped early; learn() (study/learn.hpp) adds the plan's part and the baselines.
StreamResult run_stream(const log::Dataset& data, const Split& split, OnlineModel& model,
                        const StreamOptions& options);

}  // namespace kelpie::study
