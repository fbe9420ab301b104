// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kelpie {

/// The ocean current of a log: a horizontal velocity of the water over ground, irrotational, the
/// same wherever the vehicle was, constant or slowly wandering in time. The equations of motion
/// hold for velocities through the water (Fossen 2011, eq. 8.2 to 8.6, for a vehicle that is
/// level):
///
///     u_r = u − c₁ cos ψ − c₂ sin ψ         u̇_r = u̇ − r (c₂ cos ψ − c₁ sin ψ)
///     v_r = v + c₁ sin ψ − c₂ cos ψ         v̇_r = v̇ + r (c₁ cos ψ + c₂ sin ψ)
///
/// ψ turns with the yaw rate r; c₁ goes along the heading 0, c₂ along a quarter turn. The default
/// is still water.
struct Current {
  std::string heading{};  ///< column of the log
  double unit = 1.0;      ///< of the heading [rad]; below 0: the heading falls while r > 0
  std::string surge{}, sway{}, yaw_rate{};        ///< inputs u, v [m/s], r [rad/s]
  std::array<std::size_t, 2> targets{0, 1};       ///< places of u̇, v̇ [m/s²]
  std::vector<double> times_s{};                  ///< ascending, of the log
  std::vector<std::array<double, 2>> velocity{};  ///< c₁, c₂ at these times [m/s]

  bool operator==(const Current&) const = default;

  bool none() const { return times_s.empty(); }

  /// c₁, c₂ at the time `t` of the log: in straight lines between the times, and constant before
  /// the first and after the last time. Requires a current. Allocates nothing.
  std::array<double, 2> at(double t) const;

  /// c in the body's surge and sway [m/s] at a reading of the heading in the log's unit. Requires a
  /// current. Allocates nothing.
  std::array<double, 2> in_body(double reading, double t) const;

  /// The least and the largest speed at the times [m/s]. Requires a current.
  std::array<double, 2> speeds() const;

  /// "a current of 0.1 to 0.4 m/s, on average 0.22 m/s towards 345° of psi".
  std::string text() const;

  /// Throws InputError (field) on times that do not ascend, a number that is not finite, a unit of
  /// 0, and on another number of velocities than times.
  void validate() const;
};

/// What a rotor, shaft, rudder or fin makes of its command c, in the unit of the command:
///
///     e = shaped(c − neutral)                  dead band, other gain astern
///     a' = clip((e(t − delay) − a) / lag, −rate, rate)
///
/// a stands in place of the command in the equation of motion. The default changes nothing.
struct Actuator {
  double neutral = 0.0;    ///< command at rest
  double dead_band = 0.0;  ///< commands so near to neutral have no effect; >= 0
  double astern = 1.0;     ///< gain below neutral, where the gain above is 1; > 0
  double lag_s = 0.0;      ///< time constant [s]; >= 0
  double rate = 0.0;       ///< fastest change per second; 0: unlimited
  double delay_s = 0.0;    ///< pure delay [s], at most Alignment::kMostS; >= 0

  bool operator==(const Actuator&) const = default;

  bool none() const { return *this == Actuator{}; }
  bool takes_time() const { return lag_s > 0.0 || rate > 0.0 || delay_s > 0.0; }

  /// A number with a name for files and messages.
  struct Field {
    std::string_view name;
    double Actuator::*number;
  };
  static std::span<const Field> fields();  ///< The numbers, in the order above.

  void validate() const;  ///< Throws InputError (field) on a number not finite or out of range.

  double shaped(double command) const;  ///< e, without lag, rate and delay.
  /// The command whose shaped() is `effect`: neutral for 0.
  double command_for(double effect) const;

  /// "follows its command in 0.9 s, begins 0.1 s late"; "acts at once".
  std::string text() const;
};

/// One actuator on its way: a(t) from commands at any rate. Commands change in straight lines
/// between samples; the lag is integrated exactly for a constant command over each step, and a
/// delay is looked up in the commands kept.
class ActuatorState {
 public:
  /// `rate_hz`: usual samples per second, for the number of commands kept. Throws InputError as
  /// Actuator::validate(), and (`rate`) on a rate not above 0. Allocates.
  ActuatorState(const Actuator& actuator, double rate_hz);

  void rest() { count_ = 0; }  ///< The next command has been given for ever.

  /// a at the time `t` [s], with the command given then. Requires times that never decrease since
  /// rest(), and a finite command. Cost O(delay · rate). Allocates nothing.
  double next(double command, double t);

 private:
  struct Given {
    double t = 0.0;
    double effect = 0.0;
  };
  double effect_at(double t) const;
  const Given& kept(std::size_t before_newest) const;

  Actuator actuator_;
  std::vector<Given> ring_;
  std::size_t count_ = 0;  // given since rest()
  double value_ = 0.0;
};

/// What stands between the rows of a log and a model: a shift of all commands in time, an actuator
/// per command, and the current. With a lag of 0.5 s, the acceleration of a row belongs to the
/// commands of the row 0.5 s later: commands were logged late, or accelerations early (filters).
/// With a lag below 0, the acceleration belongs to earlier commands.
struct Alignment {
  static constexpr double kMostS = 10.0;  ///< largest lag

  double lag_s = 0.0;
  int rows = 0;                         ///< the lag in rows of the log of the search
  std::vector<std::string> commands{};  ///< aligned inputs: all but velocities
  std::vector<Actuator> actuators{};    ///< one per command; empty: all act at once
  Current water{};                      ///< of the log; the model sees velocities through the water

  /// An alignment of `inputs` at these places by a given lag, in whole rows of a log. Allocates.
  static Alignment by(double lag_s, std::span<const std::string> inputs,
                      std::span<const std::size_t> commands, double rate_hz);

  /// The alignment with these actuators, by name of the command; other commands act at once. Throws
  /// InputError (the name) on the name of no command. Allocates.
  Alignment with(const std::map<std::string, Actuator>& known) const;

  /// The command of an input whose effect, after lag and delay, is `effect`. Itself for an input
  /// without an actuator.
  double command_for(std::string_view input, double effect) const;

  bool shifts() const { return rows != 0; }
  bool none() const { return !shifts() && actuators.empty() && water.none(); }
  double rate_hz() const { return rows / lag_s; }  ///< Of the log of the search. Requires shifts().
  int rows_at(double rate_hz) const;               ///< The lag in rows of another log.
  Alignment at(double rate_hz) const;              ///< The alignment in whole rows of another log.

  /// "commands are taken 0.5 s (2 rows) later; n1, n2: follows its command in 0.2 s"; without a
  /// rate, without rows.
  std::string text(double rate_hz = 0.0) const;
};

/// Gives every row of a stream the commands of the accelerations, row by row: shifted,
/// then through their actuators. With a lag above 0 a row waits for its commands. At the ends of a
/// stretch, rows without commands of their own get the nearest commands of the stretch; actuators
/// begin a stretch at rest in its first command. Rows leave in their order, each once.
class AlignedRows {
 public:
  static constexpr int kMostRows = 1'000'000;  ///< of a shift, either way

  /// `rows`: how far commands are taken from later rows, below 0 from earlier rows. `commands`:
  /// places among the `inputs`. `actuators`: one per command, or none. A gap in time ends a
  /// stretch: a step back, or longer than kLongestStep / `rate_hz` (core/seconds.hpp). Throws
  /// InputError on a shift beyond kMostRows, a rate not above 0, a command beyond the inputs,
  /// another number of actuators, and as ActuatorState.
  AlignedRows(int rows, std::vector<std::size_t> commands, std::size_t inputs, std::size_t targets,
              double rate_hz, std::span<const Actuator> actuators = {});

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
    rest();
  }

 private:
  bool ends_before(double t) const;
  void rest();
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
  std::vector<double> ring_;           // the last distance_ + 1 rows: x, y, t
  std::vector<double> row_;            // x with its commands
  std::vector<ActuatorState> states_;  // of the commands; empty: all act at once
  std::size_t count_ = 0;              // rows of this stretch
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
  Alignment current{};          ///< the present alignment; a new alignment has to be clearly better
  /// Neutral points, dead bands and gains astern known beforehand, by command: the search begins
  /// with these numbers, without evidence.
  std::map<std::string, Actuator> known{};
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

/// Searches the shift of all commands and the actuator of each. The targets are fitted by least
/// squares (MotionTerms::alignment) in 10 contiguous folds of the rows: fitted to nine, scored on
/// the tenth. Servo pulses with a quarter of their range or more on either side of 1500 µs rest
/// there unless the error is clearly larger. From there on the search adds one property at a time
/// (neutral point, shift, lag, rate, delay), takes the simplest value within one standard error of
/// the best (Breiman et al. 1984), and keeps the property on clear evidence only: a mean gain of 3
/// % or more (in logarithms) that is at least three standard errors and appears on 60 % of the
/// folds. For properties of all commands the mean is trimmed by the least and the largest fold
/// (Yuen 1974). Delays are tried up to the first delay that explains less. A kernel ridge
/// regression on 300 rows of each fifth, for vehicles badly described by the terms, has to agree to
/// 3 %. Otherwise the present alignment stays, with the reason. Outliers are clipped; where 0.2 %
/// to 10 % of the rows have errors of six root mean squares or more, the search is repeated without
/// these rows. Dead bands and gains astern are not searched: learners represent both. Lags of their
/// own for each target explained hardly more on all vehicles at hand, and would split samples.
/// Throws InputError on states without inputs. Cost: some 50 fits, and 50 more per command, to at
/// most 5,000 rows; twice where the search is repeated.
AlignmentResult find_alignment(const AlignmentProblem& problem);

/// The lag of a command's actuator with an interval of 90 % from a log.
struct LagInterval {
  std::string command;
  double lag_s = 0.0;
  double low_s = 0.0;   ///< 0: no lag is excluded
  double high_s = 0.0;  ///< infinite: no long lag is excluded
};

/// Intervals for the commands with a lag in `alignment`, in the order of the inputs. With the rest
/// unchanged, errors on folds (find_alignment) are taken on a grid of lags, four per octave; the
/// least error lies at the vertex of a parabola, with the jackknife's standard error over
/// folds (Quenouille 1956; Tukey 1958), so that neighbours in time count as little evidence.
/// Throws InputError (command) on a command outside the inputs, and as find_alignment(). Cost:
/// some 30 fits per command.
std::vector<LagInterval> lag_intervals(const AlignmentProblem& problem, const Alignment& alignment);

/// The result of a search, with the reason.
struct CurrentResult {
  Current current;    ///< still water without evidence
  double gain = 0.0;  ///< share of the variance unexplained in still water
  std::string why;    ///< in words
};

/// Estimates the current that the accelerations of a log tell. `headings`: of the column `name`,
/// for every row of the log. Requires commands that are aligned already, and no heading among the
/// inputs. The unit and the sense of the heading follow from the turns of the vehicle.
///
/// Accelerations are fitted by least squares on velocities through the water and commands
/// (MotionTerms::alignment); the current at some times, with straight lines in between, follows by
/// variable projection (Golub & Pereyra 1973; Kaufman 1975). From still water over a constant
/// current to one that is told at up to 33 times, the simplest within one standard error of the
/// best on folds (Breiman et al. 1984) is taken, and kept on clear evidence only, as in
/// find_alignment(). Otherwise the water is still, with the reason. Cost: some 60 fits to at most
/// 3,000 rows.
CurrentResult find_current(const AlignmentProblem& problem, const std::string& name,
                           std::span<const double> headings);

}  // namespace kelpie
