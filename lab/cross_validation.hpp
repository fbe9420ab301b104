// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "lab/offline_svr.hpp"

namespace kelpie::lab {

/// How (γ, C, ε) are searched for.
struct CrossValidationOptions {
  std::vector<double> gamma{0.03, 0.1, 0.3, 1.0};
  std::vector<double> c{3.0, 10.0, 30.0};
  std::vector<double> epsilon{0.03, 0.1, 0.2};
  int folds = 5;    ///< contiguous stretches of the rows, each judged by a model of the others
  int thin = 1;     ///< only every thin-th row is used, for training and for judging
  int threads = 1;  ///< at most; the result doesn't depend on it

  /// Throws InputError naming the field when a list is empty or a number out of range.
  void validate() const;
};

/// One point of the grid. R² is pooled: squared errors of all folds over the squared deviations
/// from the mean of all rows in use.
struct CrossValidationCell {
  double gamma = 0.0;
  double c = 0.0;
  double epsilon = 0.0;
  double r2 = 0.0;
};

/// The best cell of a grid, and all that were tried.
struct CrossValidation {
  OfflineSvrSettings best;                 ///< `base` with the cell of the highest R²
  double r2 = 0.0;                         ///< its R²
  std::vector<CrossValidationCell> cells;  ///< all, γ running slowest, ε fastest
  std::size_t rows_used = 0;               ///< after thinning
};

/// Tries every cell of the grid by k-fold cross-validation over contiguous stretches of data.rows
/// (neighbours in time would leak between random folds), scaling included: each fold is
/// standardised with the moments of the rows it is trained on. Of equal cells the first wins.
/// Reads no row but those of data.rows. Throws as OfflineSvr, and InputError when a fold would be
/// left with fewer than two rows.
CrossValidation cross_validate(const TrainingRows& data, const OfflineSvrSettings& base,
                               const CrossValidationOptions& options);

}  // namespace kelpie::lab
