// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>

#include "core/text.hpp"
#include "model/tuning.hpp"

namespace kelpie {

/// What the folds say of a gain: their mean and its standard error, over the targets together.
struct FoldEvidence {
  double mean = 0.0;
  double error = 0.0;
  double share = 0.0;  ///< of the folds, with a gain

  /// `gains`: logarithms, fold × target.
  explicit FoldEvidence(const Eigen::ArrayXXd& gains) {
    const Eigen::ArrayXd folds = gains.rowwise().mean();
    const auto count = static_cast<double>(folds.size());
    mean = folds.mean();
    error = std::sqrt((folds - mean).square().sum() / (count - 1.0) / count);
    share = (folds > 0.0).cast<double>().mean();
  }

  bool is_clear() const {
    constexpr const auto& kSearch = kModelTuning.alignment;
    return mean >= kSearch.least_gain && mean >= kSearch.clear * error &&
           share >= kSearch.gaining_share;
  }

  double explained() const { return 1.0 - std::exp(-mean); }  ///< Share of the unexplained.
  std::string percent() const {
    return short_number(std::round(1000.0 * explained()) / 10.0) + " %";
  }
};

/// The place of the simplest guess within one standard error of the best (Breiman et al. 1984).
/// `errors`: of every guess, the simplest first; not empty.
inline std::size_t simplest_of_best(std::span<const Eigen::ArrayXXd> errors) {
  const auto best = std::ranges::min_element(
      errors, {}, [](const Eigen::ArrayXXd& guess) { return guess.mean(); });
  const auto chosen = std::find_if(errors.begin(), best, [&](const Eigen::ArrayXXd& simpler) {
    const FoldEvidence lost(simpler - *best);
    return lost.mean <= lost.error;
  });
  return static_cast<std::size_t>(chosen - errors.begin());
}

}  // namespace kelpie
