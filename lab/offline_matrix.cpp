// SPDX-License-Identifier: Apache-2.0
#include "lab/offline_matrix.hpp"

#include <set>

#include "study/metrics.hpp"

namespace kelpie::lab {
namespace {

std::vector<std::size_t> rows_of(const log::Dataset& data, const std::vector<std::size_t>& rows,
                                 int configuration) {
  std::vector<std::size_t> found;
  for (const std::size_t row : rows) {
    if (data.configurations[row] == configuration) {
      found.push_back(row);
    }
  }
  return found;
}

}  // namespace

std::vector<int> configurations_of(const log::Dataset& data) {
  const std::set<int> numbers(data.configurations.begin(), data.configurations.end());
  return {numbers.begin(), numbers.end()};
}

OfflineModel train_offline(const log::Dataset& data, const study::Split& split, std::size_t axis,
                           int configuration, const CrossValidationOptions& options) {
  const std::vector<std::size_t> training = rows_of(data, split.training, configuration);
  const TrainingRows rows{.x = data.inputs,
                          .inputs = data.input_names.size(),
                          .y = data.targets,
                          .targets = data.target_names.size(),
                          .target = axis,
                          .rows = training};
  const CrossValidation chosen = cross_validate(rows, OfflineSvrSettings{}, options);
  const OfflineSvr svr(rows, chosen.best);
  OfflineModel model{configuration, chosen.best, chosen.r2, training.size(), {}};
  for (const int other : configurations_of(data)) {
    std::vector<double> truth;
    std::vector<double> predicted;
    for (const std::size_t row : rows_of(data, split.held_out, other)) {
      truth.push_back(rows.target_of(row));
      predicted.push_back(svr.predict(rows.input(row)));
    }
    model.r2.push_back(study::r_squared(truth, predicted));
  }
  return model;
}

}  // namespace kelpie::lab
