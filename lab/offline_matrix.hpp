// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "lab/cross_validation.hpp"
#include "log/dataset.hpp"
#include "study/split.hpp"

namespace kelpie::lab {

/// An off-line SVR of an axis, trained on one configuration and tested on each.
struct OfflineModel {
  int trained_on = 0;           ///< configuration
  OfflineSvrSettings settings;  ///< chosen by cross-validation on its training rows
  double cross_validated_r2 = 0.0;
  std::size_t training_rows = 0;
  std::vector<double> r2;  ///< on the held-out rows of each configuration, in ascending order
};

/// The models of an axis, by configuration in ascending order.
struct OfflineMatrix {
  std::string axis;  ///< target column
  std::vector<OfflineModel> models;
};

/// The configurations of a dataset in ascending order.
std::vector<int> configurations_of(const log::Dataset& data);

/// The paper's off-line baseline: (γ, C, ε) by cross-validation on the configuration's training
/// rows (never on held-out rows), then LIBSVM on the training rows. Throws as cross_validate().
OfflineModel train_offline(const log::Dataset& data, const study::Split& split, std::size_t axis,
                           int configuration, const CrossValidationOptions& options);

}  // namespace kelpie::lab
