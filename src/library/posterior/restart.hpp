// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/roomy_vector.hpp"
#include "kelpie/core/archive.hpp"
#include "posterior/evidence.hpp"
#include "posterior/posterior.hpp"
#include "posterior/tuning.hpp"

namespace kelpie {

/// A posterior of the terms alone that learns the rows since a later row, against the live
/// posterior of all rows (Evidence). The restart's errors are those of weights of some age, for
/// neighbouring rows resemble each other. Allocates in the constructor only.
class Restart {
 public:
  /// `enough`: evidence of a restart that wins [nat]; `ahead_s`: least age of weights [s].
  Restart(std::size_t terms, double enough, double ahead_s = kPosterior.ahead_s);

  /// Begins with the row of this number, at the time t; not an alternative any more at `until_s`.
  void begin(std::size_t row, double t, double until_s);
  /// Begins with what `live` knows by the terms, which weighs as `kept` independent samples.
  void begin_from(const Posterior& live, double kept, double t,
                  std::span<const std::uint8_t> group);
  void end() { until_s_ = begin_s_; }

  void live_until(double until_s) { until_s_ = until_s; }  ///< Of a restart that runs.

  bool runs(double t) const { return t < until_s_; }
  std::size_t first_row() const { return row_; }
  double begin_s() const { return begin_s_; }

  /// Scores what both posteriors say of the row of the time t, then learns the row. `phi`: features
  /// of the row, those of the terms first; `alike`: rows of one independent sample, at least.
  void update(std::span<const double> phi, double y, double t, double trust, const Posterior& live,
              double alike, std::span<const std::uint8_t> group);

  /// Whether the rows since the begin are those of another vehicle, or the first after garbage:
  /// the evidence is clear, and the restart as old as the live posterior, of `learned_s` seconds,
  /// or older than garbage lasts.
  bool wins(double t, double learned_s) const;

  bool leads() const { return evidence_.leads(); }  ///< Evidence is left.
  bool is_better() const { return evidence_.is_clear(); }
  const Posterior& young() const { return young_; }
  /// Whether errors are smaller than those of the mean of the targets, as garbage's are not.
  bool explains() const { return explained_ > kPosterior.explained * scored_; }

  void forget_evidence() { evidence_.clear(); }

  void visit(Archive& archive);  ///< core/archive.hpp

  static std::size_t bytes(std::size_t terms) {
    return Posterior::bytes(terms, terms) + 2 * terms * sizeof(double);
  }

 private:
  void keep_weights(double t);

  std::size_t terms_;
  double ahead_s_;
  Posterior young_;
  RoomyVector<double> scored_weights_, next_weights_;  ///< of that age or more, and later
  double kept_s_ = 0.0;                                ///< time of the latter [s]
  std::size_t row_ = 0;
  double begin_s_ = 0.0, until_s_ = 0.0;  ///< [s]
  double scored_ = 0.0;                   ///< rows
  double explained_ = 0.0;                ///< by terms, beside the mean [nat]
  Evidence evidence_;
};

}  // namespace kelpie
