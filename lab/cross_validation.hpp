// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "lab/offline_svr.hpp"
#include "log/dataset.hpp"
#include "study/split.hpp"

namespace kelpie::lab {

/// Rows dealt out for one fold of a cross-validation.
struct FoldRows {
  std::vector<std::size_t> others;    ///< to learn from
  std::vector<std::size_t> held_out;  ///< to be judged on
};

/// Folds of rows: contiguous stretches, or every `count`-th row, whose neighbours in time are in
/// other folds and so leak. Interleaved folds estimate the score under a random split.
struct Folds {
  std::size_t count = 5;
  bool interleaved = false;

  /// Requires fold < count.
  FoldRows rows(std::span<const std::size_t> rows, std::size_t fold) const;
};

/// The search for (γ, C, ε).
struct CrossValidationOptions {
  std::vector<double> gamma{0.03, 0.1, 0.3, 1.0};
  std::vector<double> c{3.0, 10.0, 30.0};
  std::vector<double> epsilon{0.03, 0.1, 0.2};
  int folds = 5;             ///< parts of the rows, each scored by a model of the rest
  bool interleaved = false;  ///< Folds::interleaved
  int thin = 1;              ///< only every thin-th row is used, for training and scoring
  int threads = 1;           ///< at most; the result is the same

  /// Throws InputError naming the field when a list is empty or a number out of range.
  void validate() const;
};

/// A point of the grid. R² is pooled: squared errors of all folds over the squared deviations
/// from the mean of all rows in use.
struct CrossValidationCell {
  double gamma = 0.0;
  double c = 0.0;
  double epsilon = 0.0;
  double r2 = 0.0;
};

/// The best cell of a grid, and the whole grid.
struct CrossValidation {
  OfflineSvrSettings best;                 ///< `base` with the cell of the highest R²
  double r2 = 0.0;                         ///< of the best cell
  std::vector<CrossValidationCell> cells;  ///< all, γ running slowest, ε fastest
  std::size_t rows_used = 0;               ///< after thinning
};

/// Tries every cell of the grid by k-fold cross-validation on data.rows. Each fold is standardised
/// with the moments of the fold's training rows. Of equal cells the first wins. Reads rows of
/// data.rows only. Throws as OfflineSvr, and InputError on a fold with fewer than two rows.
CrossValidation cross_validate(const TrainingRows& data, const OfflineSvrSettings& base,
                               const CrossValidationOptions& options);

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
/// rows (never on held-out rows), then LIBSVM on the training rows. With `terms`, LIBSVM learns the
/// remainder of least squares on Fossen's terms over the training rows. Throws as cross_validate().
OfflineModel train_offline(const log::Dataset& data, const study::Split& split, std::size_t axis,
                           int configuration, const CrossValidationOptions& options,
                           bool terms = false);

}  // namespace kelpie::lab
