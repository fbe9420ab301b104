// SPDX-License-Identifier: Apache-2.0
#include "lab/cross_validation.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <span>
#include <string>

#include "jobs/run_all.hpp"
#include "kelpie/learner/recursive_least_squares.hpp"
#include "study/metrics.hpp"

namespace kelpie::lab {
namespace {

void check_list(const std::vector<double>& values, const char* field, const Range& range) {
  if (values.empty()) {
    throw InputError(field, "no values to try; there has to be one or more");
  }
  for (const double value : values) {
    require_range(field, value, range);
  }
}

std::vector<std::size_t> thinned(std::span<const std::size_t> rows, int thin) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < rows.size(); i += static_cast<std::size_t>(thin)) {
    kept.push_back(rows[i]);
  }
  return kept;
}

std::vector<CrossValidationCell> grid(const CrossValidationOptions& options) {
  std::vector<CrossValidationCell> cells;
  for (const double gamma : options.gamma) {
    for (const double c : options.c) {
      for (const double epsilon : options.epsilon) {
        cells.push_back({gamma, c, epsilon, 0.0});
      }
    }
  }
  return cells;
}

OfflineSvrSettings settings_of(const OfflineSvrSettings& base, const CrossValidationCell& cell) {
  OfflineSvrSettings settings = base;
  settings.gamma = cell.gamma;
  settings.c = cell.c;
  settings.epsilon = cell.epsilon;
  return settings;
}

// The squared error on the rows of a fold, of a model of all other folds.
double squared_error(const TrainingRows& data, const OfflineSvrSettings& settings,
                     const FoldRows& fold) {
  TrainingRows training = data;
  training.rows = fold.others;
  const OfflineSvr svr(training, settings);
  double sum = 0.0;
  for (const std::size_t row : fold.held_out) {
    const double error = svr.predict(data.input(row)) - data.target_of(row);
    sum += error * error;
  }
  return sum;
}

double squared_deviation(const TrainingRows& data) {
  Moments moments(1);
  for (const std::size_t row : data.rows) {
    const double y = data.target_of(row);
    moments.add({&y, 1});
  }
  return moments.covariance()(0, 0) * static_cast<double>(data.rows.size() - 1);
}

}  // namespace

FoldRows Folds::rows(std::span<const std::size_t> rows, std::size_t fold) const {
  const std::size_t first = rows.size() * fold / count;
  const std::size_t last = rows.size() * (fold + 1) / count;
  FoldRows dealt;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool held_out = interleaved ? i % count == fold : first <= i && i < last;
    (held_out ? dealt.held_out : dealt.others).push_back(rows[i]);
  }
  return dealt;
}

void CrossValidationOptions::validate() const {
  check_list(gamma, "gamma", {.low = 0.0, .open = true});
  check_list(c, "c", {.low = 0.0, .open = true});
  check_list(epsilon, "epsilon", {.low = 0.0});
  require_range("folds", folds, {.low = 2.0, .high = 1000.0});
  require_range("thin", thin, {.low = 1.0});
  require_range("threads", threads, {.low = 1.0, .high = 1024.0});
}

CrossValidation cross_validate(const TrainingRows& data, const OfflineSvrSettings& base,
                               const CrossValidationOptions& options) {
  options.validate();
  const auto folds = static_cast<std::size_t>(options.folds);
  const std::vector<std::size_t> rows = thinned(data.rows, options.thin);
  if (rows.size() < 2 * folds) {
    throw InputError("folds", std::to_string(rows.size()) + " rows for " + std::to_string(folds) +
                                  " folds; there have to be " + std::to_string(2 * folds) +
                                  " or more");
  }
  TrainingRows used = data;
  used.rows = rows;
  CrossValidation result{base, 0.0, grid(options), rows.size()};

  // One place per model trained, summed up in a fixed order: threads can't change the result.
  std::vector<double> errors(result.cells.size() * folds);
  jobs::run_all(errors.size(), static_cast<std::size_t>(options.threads), [&](std::size_t i) {
    errors[i] = squared_error(used, settings_of(base, result.cells[i / folds]),
                              Folds{folds, options.interleaved}.rows(rows, i % folds));
  });
  const double total = squared_deviation(used);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    result.cells[i / folds].r2 += errors[i];
  }
  for (CrossValidationCell& cell : result.cells) {
    cell.r2 = 1.0 - cell.r2 / total;
  }
  const auto best = std::ranges::max_element(result.cells, {}, &CrossValidationCell::r2);
  result.best = settings_of(base, *best);
  result.r2 = best->r2;
  return result;
}

std::vector<int> configurations_of(const log::Dataset& data) {
  const std::set<int> numbers(data.configurations.begin(), data.configurations.end());
  return {numbers.begin(), numbers.end()};
}

OfflineModel train_offline(const log::Dataset& data, const study::Split& split, std::size_t axis,
                           int configuration, const CrossValidationOptions& options, bool terms) {
  const std::vector<std::size_t> training =
      study::of_configuration(data, split.training, configuration);
  std::optional<RecursiveLeastSquares> physics;
  if (terms) {
    physics.emplace(data.input_names, RecursiveLeastSquaresSettings{});
    for (const std::size_t row : training) {
      physics->update(data.input(row), data.target(row)[axis], data.times_s[row]);
    }
  }
  const auto known = [&](std::size_t row) {
    return physics ? physics->predict(data.input(row)) : 0.0;
  };
  std::vector<double> remainders(data.rows(), 0.0);
  for (const std::size_t row : training) {
    remainders[row] = data.target(row)[axis] - known(row);
  }
  const TrainingRows rows{
      .x = data.inputs, .inputs = data.input_names.size(), .y = remainders, .rows = training};
  const CrossValidation chosen = cross_validate(rows, OfflineSvrSettings{}, options);
  const OfflineSvr svr(rows, chosen.best);
  OfflineModel model{configuration, chosen.best, chosen.r2, training.size(), {}};
  for (const int other : configurations_of(data)) {
    std::vector<double> truth;
    std::vector<double> predicted;
    for (const std::size_t row : study::of_configuration(data, split.held_out, other)) {
      truth.push_back(data.target(row)[axis]);
      predicted.push_back(known(row) + svr.predict(data.input(row)));
    }
    model.r2.push_back(study::r_squared(truth, predicted));
  }
  return model;
}

}  // namespace kelpie::lab
