// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace kelpie {

/// A table of numbers with named columns, as a log or the simulator gives it. Rows in time order.
struct Table {
  /// The first cell of a column that is no number. The column holds NaN there, so that a log with
  /// a column of words can be used as long as nobody wants the words.
  struct Text {
    std::size_t line = 0;  ///< 0: there is none
    std::string cell;
  };

  std::string source;                        ///< file it came from, for messages
  std::vector<std::string> names;            ///< one per column, all different
  std::vector<std::vector<double>> columns;  ///< columns[c][row]; may hold NaN and infinities
  std::vector<std::size_t> lines;            ///< line in the file of each row, counted from 1
  std::vector<Text> texts;                   ///< one per column; empty when the table was made here

  std::size_t rows() const { return lines.size(); }
  /// Index of the column called `name`. Throws InputError naming the nearest when there is none.
  std::size_t find(const std::string& name) const;
  /// Throws InputError (file, line, column) when a cell of the column is no number.
  void require_numbers(std::size_t column) const;
};

/// What a learner is shown: inputs x, targets y, time t, row by row in time order. All finite.
struct Dataset {
  std::string source;
  std::vector<std::string> input_names;
  std::vector<std::string> target_names;
  std::vector<double> inputs;       ///< row-major, rows × inputs, in the log's own units
  std::vector<double> targets;      ///< row-major, rows × targets
  std::vector<double> times_s;      ///< seconds, never decreasing
  std::vector<int> configurations;  ///< number of the vehicle's configuration, 0 where not told
  std::size_t rows_read = 0;        ///< rows of the log, including those skipped
  std::size_t rows_skipped = 0;     ///< rows left out: a NaN or infinity in a column in use
  double rate_hz = 0.0;             ///< as given, or 1 / median step of the time column

  std::size_t rows() const { return times_s.size(); }
  std::span<const double> input(std::size_t row) const {
    return std::span(inputs).subspan(row * input_names.size(), input_names.size());
  }
  std::span<const double> target(std::size_t row) const {
    return std::span(targets).subspan(row * target_names.size(), target_names.size());
  }
};

/// Which columns play which part. Exactly one of `time` and `rate_hz` is given.
struct Roles {
  std::vector<std::string> inputs{};
  std::vector<std::string> targets{};
  std::string time{};           ///< name of the time column [s], or empty
  double rate_hz = 0.0;         ///< rows per second where there is no time column
  std::string configuration{};  ///< name of a column numbering the configuration, or empty
};

/// Guesses the parts from the names: a target is "Xdot", "dX" or "X_dot" where a column X exists;
/// time is "t", "time" or "stamp"; the configuration is "conf" or "configuration"; "split" is left
/// out, as are columns with words and "X_true"; the rest are inputs. Parts that `given` has are
/// kept. Throws InputError, listing the columns, when no target or no input is found.
Roles guess_roles(const Table& table, const Roles& given);

/// Takes the columns by name. Throws InputError (file, line, column) on a missing column, one
/// named twice or as input and target at once, time running backwards, a rate that is not
/// positive and finite, no time or both, a word in a column in use, an input or target that is
/// constant or never finite, fewer than two rows left.
Dataset make_dataset(const Table& table, const Roles& roles);

}  // namespace kelpie
