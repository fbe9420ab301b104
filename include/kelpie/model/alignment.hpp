// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace kelpie {

/// The shift between the commands of a log and the accelerations that the commands cause. With a
/// lag of 0.5 s, the acceleration of a row belongs to the commands of the row 0.5 s later: commands
/// were logged late, or accelerations early (filters). With a lag below 0, the acceleration belongs
/// to earlier commands: rotors, or accelerations logged late.
struct Alignment {
  static constexpr double kMostS = 10.0;  ///< largest lag

  double lag_s = 0.0;
  int rows = 0;                         ///< the lag in rows of the log of the search
  std::vector<std::string> commands{};  ///< aligned inputs: all but velocities

  /// An alignment of `inputs` at these places by a given lag, in whole rows of a log. Allocates.
  static Alignment by(double lag_s, std::span<const std::string> inputs,
                      std::span<const std::size_t> commands, double rate_hz);

  bool none() const { return rows == 0; }
  double rate_hz() const { return rows / lag_s; }  ///< Of the log of the search. Requires !none().
  int rows_at(double rate_hz) const;               ///< The lag in rows of another log.
  Alignment at(double rate_hz) const;              ///< The alignment in whole rows of another log.

  /// "commands are taken 0.5 s (2 rows) later"; without a rate, without rows.
  std::string text(double rate_hz = 0.0) const;
};

/// Gives every row of a stream the commands that belong to its accelerations, row by row. With a
/// lag above 0 a row waits for its commands. At the ends of a stretch, rows without commands of
/// their own get the nearest commands of the stretch. Rows leave in their order, each once.
class AlignedRows {
 public:
  /// `rows`: how far commands are taken from later rows, below 0 from earlier rows. `commands`:
  /// places among the `inputs`. A gap in time ends a stretch: a step longer than kLongestStep /
  /// `rate_hz` (core/seconds.hpp). Throws InputError on a rate that isn't > 0, or a command beyond
  /// the inputs.
  AlignedRows(int rows, std::vector<std::size_t> commands, std::size_t inputs, std::size_t targets,
              double rate_hz);

  /// Takes one row: inputs, targets, time [s]. Calls take(x, y, t) for each row now complete; x and
  /// y are valid until the next call. Throws InputError on another number of inputs or targets.
  /// Cost O(inputs + targets) per row. Allocates nothing.
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

  /// Ends the stretch: gives out the waiting rows, with the last commands of the stretch.
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
  std::vector<double> row_;   // x with its commands
  std::size_t count_ = 0;     // rows of this stretch
};

/// The rows of a log for the search of an alignment.
struct AlignmentProblem {
  std::span<const double> inputs;       ///< row-major, all rows of the log; finite
  std::span<const double> targets;      ///< row-major, all rows of the log; finite
  std::span<const double> times_s;      ///< never decreasing
  std::span<const int> configurations;  ///< of the vehicle, per row; empty: constant
  std::span<const std::size_t> rows;    ///< rows in use, at least one, in ascending order
  std::vector<std::string> input_names;
  std::size_t target_count = 1;
  std::string states = "auto";  ///< find_states
  double rate_hz = 1.0;         ///< usual rows per second
  int current_rows = 0;         ///< the present alignment; a new alignment has to be clearly better
};

/// The result of a search, with the reason.
struct AlignmentResult {
  Alignment alignment;  ///< its commands are filled in even without a lag
  double gain = 0.0;    ///< share of the variance unexplained by the present alignment
  std::string why;      ///< in words
};

/// Places of the commands among the inputs, in ascending order: all inputs but velocities; empty
/// where no velocity is known. Velocities are the inputs of `states`, else inputs with names of
/// velocities (named_velocities()), else for each target a different input whose slope over half a
/// second correlates best with the target (above 0.5).
std::vector<std::size_t> find_commands(const AlignmentProblem& problem);

/// find_commands() by names alone, before there are rows; empty where names don't tell.
std::vector<std::size_t> named_commands(std::span<const std::string> inputs, std::size_t targets,
                                        const std::string& states);

/// Searches one lag for all commands, from -1 to 1 s in about 20 steps of whole rows. For each lag
/// the targets are fitted by least squares on x, x|x|, products of velocities and 1, in 5
/// contiguous folds of the rows: fitted to four folds, scored on the fifth. The lag with the least
/// error is taken on clear evidence only: a mean gain of 3 % or more (in logarithms) over folds and
/// targets, a gain in 60 % of them, and no loss to a kernel ridge regression on 300 rows of each
/// fifth, which follows vehicles that the terms describe badly. Otherwise the present alignment
/// stays, with the reason. Outliers are clipped. Lags of their own for each target explained hardly
/// more on all vehicles at hand, and would split samples. Throws InputError on states that name no
/// inputs. Cost: 21 fits to at most 20,000 rows.
AlignmentResult find_alignment(const AlignmentProblem& problem);

}  // namespace kelpie
