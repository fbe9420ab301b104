// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "alignment/alignment_fit.hpp"
#include "alignment/fold_evidence.hpp"

namespace kelpie {

/// The search of find_alignment(): one property at a time, the simplest within one standard error
/// of the best, kept on clear evidence only.
class AlignmentSearch {
 public:
  /// Begins with the actuators of `known`. Keeps a reference to `fit`.
  AlignmentSearch(AlignmentFit& fit, double rate_hz, const Alignment& known);

  /// Puts the alignment that explains most in place of the present alignment of `found`, or says
  /// why the present alignment stays.
  void improve(AlignmentResult& found);

 private:
  struct Scored {
    AlignmentGuess guess;
    Eigen::ArrayXXd errors;  // AlignmentFit::log_errors()
  };
  using Guesses = std::vector<AlignmentGuess>;  // the simplest first

  Scored scored(AlignmentGuess guess);
  // A property of all commands counts where the middle folds tell it, a property of one command
  // has to hold on all.
  Scored step(const Scored& from, const Guesses& guesses, Folds counted);
  static Scored simplest(std::vector<Scored> tried, Folds counted);
  Scored descend(Scored from, const Guesses& guesses);
  Scored pulses_at_rest(Scored from);
  Scored neutral(Scored from);
  Scored shifted(const Scored& from);
  Scored lagged(const Scored& from);
  Scored each_command(Scored from);
  Scored command(Scored from, std::size_t k);
  Scored delayed(const Scored& from, std::size_t k);
  Scored refined(Scored from);
  Scored refined(Scored from, std::size_t k, double Actuator::*number, double factor);
  bool kernel_agrees(const Scored& present, const Scored& other);
  void decide(const Scored& present, const std::vector<Scored>& better, AlignmentResult& found);

  AlignmentFit& fit_;
  double rate_hz_;
  AlignmentGuess known_;
  std::vector<double> lags_s_;  // tried, ascending, from 0 on
  std::vector<double> lowest_;  // of each command, in its unit
  std::vector<double> range_;
};

}  // namespace kelpie
