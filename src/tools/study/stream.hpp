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

/// Options of run_stream().
struct StreamOptions {
  /// Training samples between two validation points; 0: 200 points in all.
  std::size_t validate_every = 0;
  /// Samples at which further validation points are taken, ascending.
  std::vector<std::size_t> also_at{};
  /// Called after every sample with the number of shown samples; false stops the stream.
  std::function<bool(std::size_t)> keep_going = [](std::size_t) { return true; };
  /// Training samples between two calls of `save`; 0: never. A stop and the end of the stream call
  /// `save` too. Arguments: shown samples, and the stream's results so far. The caller saves the
  /// model.
  std::size_t save_every = 0;
  std::function<void(std::size_t, const std::string&)> save{};
  /// State from `save`, to resume the stream. Requires the same data, split and options, and the
  /// model of that moment. Empty: start from the first sample.
  std::string_view resume{};
  std::string resume_file{};  ///< source file of `resume`, for messages
};

/// The paper's evaluation. The model learns the training rows of `split` in the order of time, in
/// the units of the log; every `validate_every` samples its axes predict the held-out rows of the
/// current configuration. Requires an axis per target. Throws InputError on a `resume` of another
/// stream. Ensures: the stream's part of the result is complete, also after a stop; learn()
/// (study/learn.hpp) adds the plan's part and the baselines.
StreamResult run_stream(const log::Dataset& data, const Split& split, OnlineModel& model,
                        const StreamOptions& options);

}  // namespace kelpie::study
