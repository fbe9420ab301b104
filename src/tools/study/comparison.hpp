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

/// Kind of a contender.
enum class ContenderKind : std::uint8_t {
  kelpie,   ///< with the base settings
  variant,  ///< kelpie with one other setting
  least_squares,
  mean,
  last_value,
};

/// A model in a comparison.
struct Contender {
  ContenderKind kind = ContenderKind::kelpie;
  std::string name;  ///< for people; of a variant the text of --set, as in "adapt=none"
  /// Makes the model; called by any thread.
  std::function<std::unique_ptr<OnlineModel>()> make;
};

/// kelpie or a variant. Requires that `data` outlives the contender. Throws InputError, naming the
/// column, where no scaling can be found on line (training_scales).
Contender make_contender(ContenderKind kind, std::string name, const log::Dataset& data,
                         const Split& split, const ModelSettings& settings);

/// The baselines of a log (baselines.hpp). Requires that `data` outlives the contenders.
std::vector<Contender> baseline_contenders(const log::Dataset& data);

/// Result of a contender. `stream` lacks times of updates, intervals and held-out truths, which
/// only a page about one model shows. The last value has an R² one step ahead only.
struct Contest {
  ContenderKind kind = ContenderKind::kelpie;
  std::string name;
  StreamResult stream;
  double update_us =
      0.0;  ///< median time of an update of all axes, as the sum of the axes' medians
  /// Of a variant that gains on the held-out rows: its mean gain over kelpie on each inner split of
  /// the training rows. Empty: not asked for, or too few rows for inner splits.
  std::vector<double> inner_gains{};
};

/// R² of a contest on held-out rows that a user has a use for: 0 for R² below 0, which is worse
/// than the held-out rows' own mean, however much.
double use_of(double r2);

/// Mean over the axes on which both have an R², of how much more use `contest` is; NaN: none.
double mean_gain(const StreamResult& contest, const StreamResult& kelpie);

/// The training rows of `split` as splits of their own: fives of pieces, and the tail. Empty for
/// too few rows.
std::vector<Split> inner_splits(const Split& split);

/// Contenders on the same rows.
struct Comparison {
  std::vector<Contest> contests;  ///< in the order of the contenders
  /// Samples of the score one step ahead, for each axis: predicted by every contender that ever
  /// predicts.
  std::vector<std::size_t> one_step_samples;
  /// The variant to use in place of kelpie: the one with the largest of its smallest gains, among
  /// those with a clear gain (kTuning.comparison) on every inner split and on the held-out rows.
  /// Null: none.
  const Contest* better_variant() const;

  /// Contenders that couldn't be made, with the reason; filled in by the caller.
  std::vector<std::pair<std::string, std::string>> left_out;
};

/// Options of compare().
struct CompareOptions {
  std::size_t threads = 0;  ///< 0: one per core
  /// Called with the finished share, 0 to 1, by one thread at a time; false stops.
  std::function<bool(double)> keep_going = [](double) { return true; };
};

/// Shows the training rows to every contender (run_stream) and scores all on the same held-out
/// rows. Variants with a clear gain there are held beside kelpie once more, on inner splits of the
/// training rows. Ensures: the result depends on data, split and contenders only. A result stopped
/// by keep_going is incomplete and useless.
Comparison compare(const log::Dataset& data, const Split& split,
                   const std::vector<Contender>& contenders, const CompareOptions& options);

}  // namespace kelpie::study
