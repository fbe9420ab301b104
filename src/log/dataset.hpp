// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kelpie/motion/unit.hpp"

namespace kelpie::log {

/// A table of numbers with named columns, as a log or the simulator gives it. Rows in time order.
struct Table {
  /// The cells of a column that are no numbers. The column holds NaN there, so that a log with a
  /// column of words can be read as long as nobody uses that column.
  struct Text {
    std::size_t line = 0;  ///< of the first one, counted from 1; 0: all are numbers or empty
    std::string cell;      ///< the first one, shortened
    std::vector<std::pair<std::size_t, std::string>> words{};  ///< row and cell, in their order
    bool is_time = false;  ///< all were time stamps; the column has s since the first one instead
  };

  std::string source;                        ///< file it came from, for messages
  std::vector<std::string> names;            ///< one per column, all different
  std::vector<std::vector<double>> columns;  ///< columns[c][row]; may hold NaN and infinities
  std::vector<std::size_t> lines;            ///< line in the file of each row, counted from 1
  std::vector<Text> texts;                   ///< one per column as read; none: all numbers
  std::vector<std::string> units{};          ///< one per column as read; none, or empty: not told

  std::size_t rows() const { return lines.size(); }
  /// Index of the column called `name`. Throws InputError naming the nearest when there is none.
  std::size_t find(const std::string& name) const;
  /// Whether a cell of the column isn't a number.
  bool has_text(std::size_t column) const {
    return column < texts.size() && texts[column].line > 0;
  }
  /// Whether more of its cells are words than numbers: remarks, not a measurement.
  bool is_of_words(std::size_t column) const;
  /// Whether it was read from time stamps.
  bool is_time(std::size_t column) const { return column < texts.size() && texts[column].is_time; }
  /// How many s one of its numbers is, as time: of a column in ms 0.001; without a unit 1. Throws
  /// InputError (file, column) on a unit that is none of time.
  double seconds_per_unit(std::size_t column) const;
  /// Throws InputError (file, line, column) showing the text when a cell of the column is no
  /// number. Whoever uses a column calls it first.
  void require_numbers(std::size_t column) const;
};

/// "the columns are u, v", the first 200 of them: for messages.
std::string columns_text(const Table& table);

/// What a learner is shown: inputs x, targets y, time t, row by row in time order. All finite.
struct Dataset {
  std::string source;
  std::vector<std::string> input_names;
  std::vector<std::string> target_names;
  std::vector<double> inputs;       ///< row-major, rows × inputs, in the log's own units
  std::vector<double> targets;      ///< row-major, rows × targets
  std::vector<double> times_s;      ///< seconds, never decreasing
  std::vector<int> configurations;  ///< number of the vehicle's configuration, 0 where not told
  std::vector<bool> held_out;       ///< what a column says of each row; empty: no column does
  std::size_t rows_read = 0;        ///< rows of the log, including those skipped
  std::size_t rows_skipped = 0;     ///< rows left out: a NaN or infinity in a column in use
  double rate_hz = 0.0;             ///< as given, or 1 / median of the steps of time that aren't 0
  std::map<std::string, Unit> units;  ///< of columns, as given; for display only

  std::size_t rows() const { return times_s.size(); }
  /// Inputs of a row, in the order of input_names.
  std::span<const double> input(std::size_t row) const {
    return std::span(inputs).subspan(row * input_names.size(), input_names.size());
  }
  /// Targets of a row, in the order of target_names.
  std::span<const double> target(std::size_t row) const {
    return std::span(targets).subspan(row * target_names.size(), target_names.size());
  }
};

/// Which columns play which part. At most one of `time` and `rate_hz` is given.
struct Roles {
  std::vector<std::string> inputs{};
  std::vector<std::string> targets{};
  std::string time{};           ///< name of the time column [s], or empty
  double rate_hz = 0.0;         ///< rows per second where there is no time column; 0: not given
  std::string configuration{};  ///< name of a column numbering the configuration, or empty
  std::string held_out{};       ///< name of a column of 0 and 1 (held out for validation), or empty
  std::map<std::string, std::string> units{};  ///< of columns, as Unit::parse reads them
};

/// Names of columns that are taken for time.
inline constexpr std::array<std::string_view, 3> kTimeNames{"t", "time", "stamp"};

/// Guesses the parts from the names: a target is "Xdot", "dX" or "X_dot" where a column X exists
/// that isn't time; time (unless a rate is given) is one of kTimeNames, or else the first column of
/// time stamps; the configuration is "conf"
/// or "configuration"; "split", columns of words, other time stamps and "X_true" where a column X
/// exists are left out; the rest are inputs. Parts that `given` has already are kept. Throws
/// InputError when no target or no input is found, or more inputs than a model takes.
Roles guess_roles(const Table& table, const Roles& given);

/// Which columns of words guess_roles leaves out of the inputs, for people: a line each.
std::string left_out_text(const Table& table, const Roles& given);

/// Takes the columns by name. Rows with a NaN or infinity in a column in use are skipped; equal
/// time stamps are allowed; columns not in use never matter.
/// Throws InputError (file, line, column) on a missing column, one named twice or as input and
/// target at once, no inputs, no targets, text in a column in use, a column in use without a
/// finite number, an input or target that is constant, time that runs backwards or stands still,
/// a rate that is not positive and finite, no time or both, a configuration that is no whole
/// number, a mark of held-out rows that is neither 0 nor 1, fewer than two rows left, a unit that
/// is none or of no column.
Dataset make_dataset(const Table& table, const Roles& roles);

/// Commands to follow rather than to learn: a Dataset without targets. Uses `inputs`, `time`
/// (guessed if neither time nor rate is given) and `rate_hz` of the roles. An input in `constants`
/// has this number in every row and needs no column. No row is skipped; equal rows are allowed.
/// Throws InputError (file, line, column) on a missing column, a cell without a finite number,
/// times that do not increase, no time, fewer than two rows.
Dataset make_commands(const Table& table, const Roles& roles,
                      const std::map<std::string, double>& constants);

/// Joins logs of one vehicle, in the given order. A log whose clock does not begin after the end of
/// the previous log begins one minute after that end. Requires at least one log. Throws InputError
/// naming the log with other inputs, other targets, a rate more than 10 % off the first log's, or a
/// column of held-out rows in only some of the logs.
Dataset joined(std::vector<Dataset> logs);

/// Rows per second: 1 / median of the steps of time that aren't 0; 0 when all stamps are equal.
double measured_rate(const std::vector<double>& times_s);

}  // namespace kelpie::log
