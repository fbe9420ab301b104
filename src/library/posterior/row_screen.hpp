// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "kelpie/core/archive.hpp"
#include "posterior/features.hpp"
#include "posterior/posterior.hpp"
#include "posterior/recent_rows.hpp"
#include "posterior/restart.hpp"

namespace kelpie {

/// Decides which rows a live posterior learns, and when: rows in which the vehicle moves as never
/// before teach most, and garbage destroys most, and both surprise.
///
/// - A row waits where its error has e² > 16 (σ² + s²), or where next to nothing is known of its
///   inputs (s² beyond 20 variances of the targets), for such a row would rule by itself. Other
///   rows are due at once.
/// - Where the live posterior explains less than a fifth of the variance of the targets, as of a
///   vehicle at rest, and nothing is known of a row (s² beyond 1,000), all begins anew with it.
/// - Two seconds after the last row that waits, the rows that wait are judged together, by what the
///   terms' posterior would say at the inputs of all rows learned so far if it had learned them as
///   well, by Gauss's likelihood: the mean square of the difference, in variances of the noise
///   (Cook's distance: Cook 1977). Beyond ½ they contradict the vehicle known, and are dropped.
///   Else they are learned: coherent errors as those of a rare manoeuvre, by Huber's likelihood,
///   others by Student's.
/// - A Restart begins with each row that waits as the first, and 10, 20 and 40 s after the first
///   row of all, for garbage at the start surprises nobody. Where a restart wins, the live
///   posterior has to be forgotten, and the rows since the restart's begin are due; but where rows
///   that waited do not contradict the vehicle known (a distance of 0.2, of errors less their mean:
///   an offset of a sensor is no other vehicle), they are learned beside.
/// - Rows on probation: while rows wait, a follower begins with what is known by the terms, which
///   weighs as ten independent samples, and learns all rows. Where the follower has been better, by
///   3 nats, its terms are for service until the rows are judged.
/// - After 36 s, rows that wait are due, whatever they are: garbage ends. Where the terms of the
///   restart explain no more than the mean, after 144 s.
///
/// Cost of a row O(n²) for n terms, of a judgement O(n³). Allocates in the constructor only.
class RowScreen {
 public:
  /// `terms`: the number of the first features, with the constant.
  RowScreen(std::size_t inputs, std::size_t terms);

  /// A row arrives, of the features `phi`; `live` has not learned the row yet.
  void add(const RecentRows::Row& row, const Features& features, std::span<const double> phi,
           Posterior& live);

  bool last_waits() const { return last_waits_; }  ///< The last row waits.

  /// The posterior of the terms that follows rows on probation; null where none is in service.
  const Posterior* on_probation() const {
    return waiting() && follower_.is_better() ? &follower_.young() : nullptr;
  }

  struct Won {
    double since_s;  ///< time of the first row [s]
    bool is_change;  ///< of the vehicle: rows surprised, after more than what may be garbage
  };
  /// The restart that won with the last row: whatever was learned is to be forgotten before the
  /// next row is learned.
  std::optional<Won> won() const { return won_; }

  /// Rows that wait are judged at once, as at the end of a log. `live`: as of add().
  void end_waiting(const Features& features, const Posterior& live);

  /// `live` knows a change of the vehicle since a time [s] from now on: rows since then that wait
  /// or were dropped are due.
  void believe_change(double since_s);

  std::int64_t dropped() const { return dropped_; }  ///< Rows dropped with the last row.

  struct Due {
    RecentRows::Row row;
    Likelihood likelihood;
  };
  std::optional<Due> next();  ///< The oldest row that is due, which is done then.

  void visit(Archive& archive);  ///< core/archive.hpp

  static std::size_t bytes(std::size_t inputs, std::size_t terms);  ///< Memory in bytes.

 private:
  using State = RecentRows::State;
  static constexpr std::size_t kRows = 2048;
  static constexpr std::size_t kRestarts = 3;  ///< at the start, and one at rows that wait

  bool waiting() const { return waits_since_ < rows_.end(); }
  void begin_anew(double t);
  void begin_restarts(double t);
  void run_restarts(const RecentRows::Row& row, const Features& features,
                    std::span<const double> phi, const Posterior& live);
  void take_over(const Restart& winner);
  void limit_waiting(const Features& features, const Posterior& live);
  void judge(const Features& features, const Posterior& live);
  double distance(std::size_t first, bool all, const Features& features, const Posterior& live);
  template <typename Use>
  void each_row(std::size_t first, bool all, const Features& features, Use use);
  void release(State state);

  RecentRows rows_;
  std::size_t next_ = 0;                   ///< rows before are done, or wait
  std::size_t waits_since_ = 0;            ///< the first row that waits; the end without
  double waits_s_ = 0.0, waited_s_ = 0.0;  ///< times of the first and the last row that waits [s]
  bool last_waits_ = false;
  double first_s_ = 0.0, last_s_ = 0.0;  ///< times of the first row and of the last [s]
  double learned_s_ = 0.0;               ///< of rows that were due at once [s]
  bool begun_ = false;
  std::array<Restart, kRestarts + 1> restarts_;
  Restart follower_;         ///< of rows on probation
  std::size_t started_ = 0;  ///< restarts since the start
  std::optional<Won> won_;
  std::int64_t dropped_ = 0;
  Posterior before_, after_;  ///< scratch of a judgement
  std::vector<double> phi_;   ///< scratch
};

}  // namespace kelpie
