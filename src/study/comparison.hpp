// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "kelpie/model/online_model.hpp"
#include "kelpie/model/settings.hpp"
#include "study/result.hpp"
#include "study/split.hpp"

namespace kelpie::study {

/// What a contender is.
enum class ContenderKind : std::uint8_t {
  kelpie,   ///< with the settings that the others are compared with
  variant,  ///< kelpie with one setting more
  least_squares,
  mean,
  last_value,
};

/// Who enters a comparison.
struct Contender {
  ContenderKind kind = ContenderKind::kelpie;
  std::string name;  ///< for people; of a variant what --set takes, as in "adapt=none"
  /// Makes it; called by any thread.
  std::function<std::unique_ptr<OnlineModel>()> make;
};

/// kelpie or a variant of it. Requires that `data` outlives it. Throws InputError where the scaling
/// could never be found on line (training_scales), naming the column.
Contender make_contender(ContenderKind kind, std::string name, const log::Dataset& data,
                         const Split& split, const ModelSettings& settings);

/// The baselines that can be made for a log (baselines.hpp). Requires that `data` outlives them.
std::vector<Contender> baseline_contenders(const log::Dataset& data);

/// What came of a contender. Of `stream`, what only a page about one model shows is left out:
/// times, intervals, truths. The last value has no R² but one step ahead: it tells nothing of
/// held-out rows.
struct Contest {
  ContenderKind kind = ContenderKind::kelpie;
  std::string name;
  StreamResult stream;
};

/// Contenders on the same rows.
struct Comparison {
  std::vector<Contest> contests;  ///< in the order of the contenders
  /// Samples that one step ahead is judged on, of each axis: those that all contenders predicted,
  /// but for those that never did.
  std::vector<std::size_t> one_step_samples;
  /// Contenders that couldn't be made, and why: for the caller to fill in.
  std::vector<std::pair<std::string, std::string>> left_out;
};

/// How a comparison is run and watched.
struct CompareOptions {
  std::size_t threads = 0;  ///< 0: one per core
  /// Called with the share done, 0 to 1; false stops. One thread at a time.
  std::function<bool(double)> keep_going = [](double) { return true; };
};

/// Shows the training rows to every contender (run_stream) and judges all of them on the same
/// held-out rows. Ensures: the result depends on data, split and contenders alone. Once stopped by
/// keep_going it is incomplete and of no use.
Comparison compare(const log::Dataset& data, const Split& split,
                   const std::vector<Contender>& contenders, const CompareOptions& options);

}  // namespace kelpie::study
