// SPDX-License-Identifier: Apache-2.0
#include "lab/settings_search.hpp"

#include <algorithm>
#include <cmath>

#include "study/metrics.hpp"

namespace kelpie::lab {
namespace {

// The truth of a fold's rows and the predictions of a learner that was shown all other folds.
void ask(const log::Dataset& data, std::size_t axis, const FoldRows& fold, OnlineRegressor& learner,
         std::vector<double>& truth, std::vector<double>& predicted) {
  for (const std::size_t row : fold.others) {
    learner.update(data.input(row), data.target(row)[axis], data.times_s[row]);
  }
  learner.learn_held_back();
  for (const std::size_t row : fold.held_out) {
    truth.push_back(data.target(row)[axis]);
    predicted.push_back(learner.predict(data.input(row)));
  }
}

}  // namespace

FoundSettings search_settings(const log::Dataset& data, std::span<const std::size_t> rows,
                              std::size_t axis, const Folds& folds, const SettingsGrid& grid,
                              const AxisFactory& make, const std::function<bool()>& keep_going) {
  FoundSettings best{{}, -HUGE_VAL, 0};
  for (const auto& [name, values] : grid) {
    best.values.emplace_back(name, values.front());
  }
  const auto score = [&](const NamedValues& values) {
    std::vector<double> truth;
    std::vector<double> predicted;
    for (std::size_t fold = 0; fold < folds.count && keep_going(); ++fold, ++best.runs) {
      ask(data, axis, folds.rows(rows, fold), *make(data, axis, values), truth, predicted);
    }
    const double r2 = study::r_squared(truth, predicted);
    return std::isfinite(r2) ? r2 : -HUGE_VAL;
  };
  best.r2 = score(best.values);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    for (const std::string& value : grid[i].second) {
      NamedValues values = best.values;
      if (values[i].second == value) {
        continue;
      }
      values[i].second = value;
      if (const double r2 = score(values); r2 > best.r2) {
        best.r2 = r2;
        best.values = values;
      }
    }
  }
  return best;
}

}  // namespace kelpie::lab
