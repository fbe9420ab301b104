// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>

#include "alignment/tuning.hpp"
#include "core/text.hpp"

namespace kelpie {

/// The folds that count. The middle ones leave out the least and the largest gain: a fold may hold
/// wild velocities, or a command that moves in no other fold.
enum class Folds { all, middle };

/// The gain that the folds tell, over the targets together: mean and standard error, of the middle
/// folds those of the trimmed mean (Yuen 1974).
struct FoldEvidence {
  double mean = 0.0;
  double error = 0.0;
  double share = 0.0;  ///< of all folds, with a gain

  /// `gains`: logarithms, fold × target; three folds or more.
  explicit FoldEvidence(const Eigen::ArrayXXd& gains, Folds counted = Folds::all) {
    Eigen::ArrayXd folds = gains.rowwise().mean();
    share = (folds > 0.0).cast<double>().mean();
    const Eigen::Index left_out = counted == Folds::middle ? 1 : 0;
    const Eigen::Index size = folds.size();
    std::ranges::sort(folds);
    folds.head(left_out) = folds[left_out];
    folds.tail(left_out) = folds[size - 1 - left_out];
    const auto all = static_cast<double>(size);
    const auto middle = static_cast<double>(size - 2 * left_out);
    mean = folds.segment(left_out, size - 2 * left_out).mean();
    error = std::sqrt((folds - folds.mean()).square().sum() * all / (all - 1.0)) / middle;
  }

  bool is_clear() const {
    constexpr const auto& kSearch = kAlignmentTuning.alignment;
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
inline std::size_t simplest_of_best(std::span<const Eigen::ArrayXXd> errors,
                                    Folds counted = Folds::all) {
  const auto best = std::ranges::min_element(
      errors, {}, [](const Eigen::ArrayXXd& guess) { return guess.mean(); });
  const auto chosen = std::find_if(errors.begin(), best, [&](const Eigen::ArrayXXd& simpler) {
    const FoldEvidence lost(simpler - *best, counted);
    return lost.mean <= lost.error;
  });
  return static_cast<std::size_t>(chosen - errors.begin());
}

}  // namespace kelpie
