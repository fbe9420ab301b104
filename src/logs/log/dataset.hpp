// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <iosfwd>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kelpie/motion/unit.hpp"

namespace kelpie::log {

/// A table of numbers with named columns, from a log or the simulator. Rows in time order.
struct Table {
  /// Non-numeric cells of a column. The column holds NaN in these cells, so that a log with an
  /// unused column of words can be read.
  struct Text {
    std::size_t line = 0;  ///< of the first such cell, counted from 1; 0: no such cell
    std::string cell;      ///< the first such cell, shortened
    std::vector<std::pair<std::size_t, std::string>> words{};  ///< row and cell, in order
    bool is_time = false;  ///< a column of time stamps, converted to s since the first stamp
  };

  std::string source;                        ///< file of origin, for messages
  std::vector<std::string> names;            ///< a name per column, all different
  std::vector<std::vector<double>> columns;  ///< columns[c][row]; may hold NaN and infinities
  std::vector<std::size_t> lines;            ///< line in the file of each row, counted from 1
  std::vector<Text> texts;                   ///< per column as read; empty: only numbers
  std::vector<std::string> units{};          ///< per column as read; "": unknown

  std::size_t rows() const { return lines.size(); }
  /// Index of the column called `name`. Throws InputError with the nearest name for a missing
  /// column.
  std::size_t find(const std::string& name) const;
  /// Whether a cell of the column isn't a number.
  bool has_text(std::size_t column) const {
    return column < texts.size() && texts[column].line > 0;
  }
  /// Whether the column has more words than numbers: remarks, not a measurement.
  bool is_of_words(std::size_t column) const;
  /// Whether the column was converted from time stamps.
  bool is_time(std::size_t column) const { return column < texts.size() && texts[column].is_time; }
  /// Length of the column's unit in s, for a column of times: 0.001 for ms; 1 without unit. Throws
  /// InputError (file, column) on a unit of another quantity.
  double seconds_per_unit(std::size_t column) const;
  /// Throws InputError (file, line, column), with the text, if a cell of the column is not a
  /// number. Every user of a column calls this function first.
  void require_numbers(std::size_t column) const;
};

/// "the columns are u, v", with the first 200 names, for messages.
std::string columns_text(const Table& table);

/// Reads a CSV log with a header line, plain or packed by gzip, zstd (howto/logs.md). The separator
/// (comma, semicolon or tab) is the most frequent in the header, or given by "sep=;"; lines end in
/// LF, CRLF or CR; blank lines and lines starting with '#' are skipped but counted; names and
/// numbers may be in double quotes, with separators and doubled quotes inside; a UTF-8 byte order
/// mark is skipped. "nan" and "inf" are numbers; an empty cell is NaN; unless commas separate
/// cells, "0,5" is 0.5; a column of time stamps becomes s since the first stamp; any other word,
/// and a number out of range, becomes NaN and part of the column's text (Table::texts). Units come
/// from the header, or from a row of units below the header (Table::units). A first column without
/// name that numbers the rows is left out. Throws InputError (file, line, column) on a missing,
/// unreadable or empty file, a folder, UTF-16 or binary content, a column without name, duplicate
/// names, a header of numbers only, a row with a wrong number of cells, a broken quotation, no
/// rows, mixed decimal commas and points, a line, columns or words beyond the bounds of
/// reference/limits.md, as file::read_content() and file::unpacked() do. Throws Failure when the
/// disk fails while reading. With `losses` a header within the rows, an empty last column, a last
/// line that is cut off and NUL bytes at the end (as after a loss of power) are left out, and told
/// there, a line each.
Table read_csv(const std::filesystem::path& file, std::string* losses = nullptr);

/// The same of the content of a file; messages call the content `source`.
Table parse_csv(std::string content, const std::string& source, std::string* losses = nullptr);

/// Header and rows, separated by commas; numbers in the shortest exact form, words as read, NaN and
/// empty cells as "nan". Requires names that are different, not empty, without line ends.
std::string csv_text(const Table& table);

/// Writes csv_text() to a file, atomically. Throws Failure as write_file_whole() does.
void write_csv(const std::filesystem::path& file, const Table& table);

/// What is known of a command's actuator beforehand, in the unit of the command.
struct KnownActuator {
  double neutral = 0.0;    ///< command at rest
  double dead_band = 0.0;  ///< commands so near to neutral have no effect; >= 0
  double astern = 1.0;     ///< gain below neutral, where the gain above is 1; > 0

  bool operator==(const KnownActuator&) const = default;
};

/// What cannot be right in a log, or hardly.
struct Mistake {
  std::string what;        ///< in words, with the figures that show the mistake
  std::string remedy;      ///< an option of the command line where an option helps
  bool is_refused = true;  ///< false: worth a word, but the log can be learned
};

/// Data for a learner: inputs x, targets y, time t, row by row in time order; all finite.
struct Dataset {
  std::string source;
  std::vector<std::string> input_names;
  std::vector<std::string> target_names;
  std::vector<double> inputs;          ///< row-major, rows × inputs, in the log's own units
  std::vector<double> targets;         ///< row-major, rows × targets
  std::vector<double> times_s;         ///< seconds, never decreasing
  std::vector<int> configurations;     ///< number of the vehicle's configuration, 0 where not told
  std::vector<bool> held_out;          ///< marks of held-out rows; empty: not marked
  std::vector<std::string> derived{};  ///< targets that are derivatives of inputs by sampling
  std::string heading_column{};        ///< empty: none
  std::vector<double> headings{};      ///< of each row, as the log has them, perhaps NaN; or empty
  /// Where inputs are means over the window of a pose: rows × 3 of x, y [m] and heading [rad] at
  /// the rows' own times (NaN: not measured), and the inputs there, for LogSource::with_poses; else
  /// empty. Headings are continuous.
  std::vector<double> poses{};
  std::vector<double> pose_inputs{};
  std::size_t rows_read = 0;          ///< rows of the log, including skipped rows
  std::size_t rows_skipped = 0;       ///< rows left out: a NaN or infinity in a column in use
  std::string time_column{};          ///< empty: rows at a rate
  double rate_hz = 0.0;               ///< as given, or 1 / median of the positive time steps
  std::map<std::string, Unit> units;  ///< of columns, as given; for display only
  std::map<std::string, KnownActuator> actuators{};  ///< of inputs, as far as known beforehand
  std::vector<Mistake> doubts{};  ///< what the rest of the log tells of the rows (check_pose())

  std::size_t rows() const { return times_s.size(); }
  /// Inputs of a row, in the order of input_names.
  std::span<const double> input(std::size_t row) const {
    return std::span(inputs).subspan(row * input_names.size(), input_names.size());
  }
  /// Targets of a row, in the order of target_names.
  std::span<const double> target(std::size_t row) const {
    return std::span(targets).subspan(row * target_names.size(), target_names.size());
  }
  /// Place of the input of that name, if an input has it.
  std::optional<std::size_t> find_input(std::string_view name) const;
  /// The same. Throws InputError (source, name) "`need`, but is no input".
  std::size_t require_input(const std::string& name, const std::string& need) const;
  /// The same of a name that an option gave. Throws InputError (option), with the inputs there are.
  std::size_t require_input_of(std::string_view option, const std::string& name) const;
};

/// Roles of the columns. At most one of `time` and `rate_hz` is given.
struct Roles {
  std::vector<std::string> inputs{};
  std::vector<std::string> targets{};
  std::string time{};           ///< name of the time column [s], or empty
  double rate_hz = 0.0;         ///< rows per second without time column; 0: not given
  std::string configuration{};  ///< name of a column numbering the configuration, or empty
  std::string held_out{};       ///< name of a column of 0 and 1 (held out for validation), or empty
  std::string heading{};        ///< column of the vehicle's heading; empty: by name (find_heading)
  std::vector<std::string> also{};     ///< columns that are inputs, whatever a guess says
  std::vector<std::string> ignored{};  ///< columns that no guess takes for inputs or targets
  /// Units of columns, in the syntax of Unit::parse. Readers convert columns to the SI
  /// (Unit::in_si) and then tell the units of the converted columns.
  std::map<std::string, std::string> units{};
  std::map<std::string, KnownActuator> actuators{};  ///< of commands
  /// Columns of a table that are its poses, by names that tell their part ("x", "psi", "depth":
  /// pose_part_by_name()) or as part=column; empty: none.
  std::vector<std::string> pose{};
  /// Values that stand for none, as "-999" or "u=0"; "none": every velocity is a measurement, too
  /// (drop_missing()).
  std::vector<std::string> missing{};
  bool has_curves = false;  ///< measured states between messages: Interpolation::curve, not lines
};

/// The unit in the SI, and what one of the given unit is there (Unit::in_si). Throws InputError
/// (source, column) on text that is no unit.
std::pair<Unit, double> si_unit(const std::string& source, const std::string& column,
                                const std::string& text);

/// Units of the columns of a table: those of its header, and over these those of `roles`, in the
/// SI. Throws as si_unit() does.
std::map<std::string, Unit> column_units(const Table& table, const Roles& roles);

/// Converts the columns named in `units` to the SI, and sets the units of the table. A unit of time
/// (`t = "ms"`) is kept for Table::seconds_per_unit(). Throws InputError on a missing column and as
/// si_unit() does.
void convert_units(Table& table, const std::map<std::string, std::string>& units);

/// How many zeros are among the pulses of a servo, in whole µs to both sides of rest; empty: other
/// values.
std::optional<std::size_t> zeros_among_pulses(std::span<const double> values);

/// Sets pulses of 0 to the pulse at rest (kNeutralPulseUs), in columns of commands whose other
/// values are pulses of servos in whole µs to both sides of rest: a disarmed autopilot sends none.
/// Columns with another unit, or of speeds by their names, stay. Returns a line for the user; ""
/// where nothing was set.
std::string set_missing_pulses(Table& table);

/// Names of columns that are taken as time.
inline constexpr std::array<std::string_view, 3> kTimeNames{"t", "time", "stamp"};

/// The column of the time of a table's rows as they are: the given one; without a column and a rate
/// the first named in kTimeNames, or else the first column of time stamps; "" for none. A draft
/// asks more names (time_field()).
std::string usual_time(const Table& table, const Roles& given);

/// Guesses roles from the names: targets are "Xdot", "dX" and "X_dot" for a column X other than
/// time; the time is usual_time(); the configuration is "conf" or "configuration". Left out are
/// "split", columns of words, further time stamps, "X_true" for a column X, ignored columns,
/// constants, counters, positions, headings, batteries, measurements (ax, imu_…, temperatures, sog,
/// satellites, power), and columns equal to an earlier input; the remaining columns are inputs,
/// velocities (velocity_axis()) first. Roles in `given` are kept. Throws InputError on an ignored
/// column that is missing or has a role, no target, no input, or more inputs than a model takes.
Roles guess_roles(const Table& table, const Roles& given);

/// The column of the vehicle's heading for the estimate of a current: psi, yaw, heading, hdg or
/// compass, also with _deg or _rad, the first with a number; empty: none. A course is no heading.
std::string find_heading(const Table& table);

/// Leaves constant columns out of the inputs that `roles` name, unless all are constant: constants
/// tell a learner nothing.
Roles without_constants(const Table& table, Roles roles);

/// The columns that guess_roles() and without_constants() leave out of the inputs and targets with
/// the reasons, for the user: a line each.
std::string left_out_text(const Table& table, const Roles& given);

/// A column beside others.
struct KnownColumn {
  std::string name;
  std::span<const double> values;
  bool is_target = false;
};

/// Of a column whose name is no command's, a velocity's or an angle's, the target or velocity that
/// its values nearly copy (as many rows), perhaps some rows later or earlier: "goes with u, read 1
/// rows later: correlation 0.99"; or "". Cost: seven passes per column of the motion.
std::string near_copy_of(const KnownColumn& column, const std::vector<KnownColumn>& motion);

/// Selects the columns by name. Rows with a NaN or infinity in a used column are skipped; equal
/// time stamps are allowed; unused columns have no effect. Throws InputError (file, line, column)
/// on a missing column, a duplicate role, no inputs, no targets, text in a used column, a used
/// column without a finite number, a constant target, decreasing or constant time, a rate
/// that is not positive and finite, both or neither of time and rate, a fractional configuration, a
/// mark of held-out rows besides 0 and 1, fewer than two remaining rows, an unknown unit, a unit
/// for a missing column.
Dataset make_dataset(const Table& table, const Roles& roles);

/// Prepares commands for a prediction, without targets. Uses `inputs`, `time` (guessed if neither
/// time nor rate is given) and `rate_hz` of the roles. An input in `constants` has this number in
/// every row and needs no column. No row is skipped; equal rows are allowed. Throws InputError
/// (file, line, column) on a missing column, a cell without a finite number, times that do not
/// increase, no time, fewer than two rows.
Dataset make_commands(const Table& table, const Roles& roles,
                      const std::map<std::string, double>& constants);

/// Whether `row` comes right after row `before` in one stretch: the next row, at most kLongestStep
/// usual steps later, of the same configuration.
bool follows(const Dataset& data, std::size_t before, std::size_t row);

/// The rows from `since_s` [s] on, of the log's own time. Throws InputError (file, --since) where
/// fewer than two rows are left.
Dataset rows_since(const Dataset& data, double since_s);

/// Joins logs of one vehicle, in the given order. A log whose clock does not begin after the end of
/// the previous log is moved to one minute after that end. Requires at least one log. Throws
/// InputError naming the log with different inputs or targets, a rate more than 10 % off the first
/// log's, or a column of held-out rows in only some of the logs.
Dataset joined(std::vector<Dataset> logs);

/// Rows per second: 1 / median of the positive time steps; 0 for equal stamps.
double measured_rate(const std::vector<double>& times_s);

}  // namespace kelpie::log
