// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace kelpie {

/// How far the commands of a log are shifted against the accelerations that they cause. With a
/// shift of 0.5 s the acceleration of a row belongs to the commands of the row 0.5 s later: they
/// were logged late, or the acceleration early (filters). Below 0 it belongs to earlier commands:
/// rotors, or an acceleration that comes late.
struct Alignment {
  static constexpr double kMostS = 10.0;  ///< no shift is larger

  double lag_s = 0.0;
  int rows = 0;                         ///< the same in rows of the log it was found on
  std::vector<std::string> commands{};  ///< inputs that are shifted: all but velocities

  bool none() const { return rows == 0; }
  double rate_hz() const { return rows / lag_s; }  ///< Of that log. Requires !none().
  int rows_at(double rate_hz) const;               ///< The shift in rows of another log.
  Alignment at(double rate_hz) const;              ///< The same, in whole rows of that log.
};

/// Gives every row of a stream the commands that belong to it, as rows come. With a shift to later
/// rows a row waits until its commands have come. At the ends of a stretch, rows whose commands are
/// missing get the nearest of the same stretch. Every row comes out once, in its order.
class AlignedRows {
 public:
  static constexpr double kLongestStep = 3.0;  ///< in usual ones, within a stretch

  /// `rows`: how far commands are taken from later rows, below 0 from earlier ones. `commands`:
  /// their places among the `inputs`. A stretch ends where two rows are more than kLongestStep
  /// steps of 1 / `rate_hz` apart. Throws InputError on a rate that isn't > 0, or a place that
  /// isn't one.
  AlignedRows(int rows, std::vector<std::size_t> commands, std::size_t inputs, std::size_t targets,
              double rate_hz);

  /// Shows one row: inputs, targets, time [s]. Calls take(x, y, t) for each row that is complete
  /// now; x and y hold until the next call. Throws InputError on another number of inputs or
  /// targets. Cost O(inputs + targets) a row. Allocates nothing.
  template <typename Take>
  void push(std::span<const double> x, std::span<const double> y, double t, Take take) {
    if (ends_before(t)) {
      finish(take);
    }
    keep(x, y, t);
    if (shift_ <= 0) {
      give(count_ - 1, count_ - 1 < distance_ ? 0 : count_ - 1 - distance_, take);
    } else if (count_ > distance_) {
      give(count_ - 1 - distance_, count_ - 1, take);
    }
  }

  /// The stretch ends here: gives out the rows that still wait, with its last commands.
  template <typename Take>
  void finish(Take take) {
    const std::size_t waiting = shift_ > 0 ? (count_ < distance_ ? count_ : distance_) : 0;
    for (std::size_t row = count_ - waiting; row < count_; ++row) {
      give(row, count_ - 1, take);
    }
    count_ = 0;
  }

 private:
  bool ends_before(double t) const;
  void keep(std::span<const double> x, std::span<const double> y, double t);
  std::span<double> slot(std::size_t row);

  template <typename Take>
  void give(std::size_t row, std::size_t from, Take take) {
    const std::span<const double> own = slot(row);
    const std::span<const double> x = with_commands(own, slot(from));
    take(x, own.subspan(inputs_, targets_), own.back());
  }
  std::span<const double> with_commands(std::span<const double> row, std::span<const double> from);

  int shift_;
  std::size_t distance_;  // |shift|
  std::vector<std::size_t> commands_;
  std::size_t inputs_;
  std::size_t targets_;
  double longest_step_s_;
  std::vector<double> ring_;  // the last distance_ + 1 rows: x, y, t
  std::vector<double> row_;   // x as it is given out
  std::size_t count_ = 0;     // rows of this stretch
};

}  // namespace kelpie
