// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "kelpie/core/archive.hpp"
#include "model/tuning.hpp"
#include "svr/robust_scale.hpp"

namespace kelpie {

/// The usual error of a model of motion, by the size of the effects at a row: a model that is right
/// to a tenth has errors in a manoeuvre that are far beyond those of a calm minute, and no sign of
/// a change. Effects count in octaves of the usual error of all rows. Allocates nothing.
class ErrorsByEffect {
 public:
  void add(double error) { all_.add(error); }  ///< Adds to the errors of all rows.

  /// Adds the error of a row where the effects of commands and drag have the root sum of squares
  /// `effect`. Of a model that is known: a rare octave keeps its errors for long.
  void add_with(double error, double effect);

  /// The usual error of all rows; infinite while unknown.
  double value() const { return all_.value(); }

  /// The usual error of rows with such effects over value(), 1 or more; 1 while value() is unknown
  /// or 0. An octave without errors enough has those of the octave below, in proportion, and
  /// at most those of the next octave with errors above.
  double ratio(double effect) const;

  void clear();  ///< Forgets the errors.

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  static constexpr std::size_t kOctaves = 8;

  std::size_t octave(double effect) const;

  RobustScale all_{kModelTuning.change.least_errors, kModelTuning.change.scatter_every};
  std::array<RobustScale, kOctaves> by_octave_ = [] {
    const RobustScale one(kModelTuning.change.octave_errors, kModelTuning.change.octave_every);
    return std::array<RobustScale, kOctaves>{one, one, one, one, one, one, one, one};
  }();
};

}  // namespace kelpie
