// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace kelpie::log {

/// Behavioural constants of the room. "By hand" means: chosen by hand, no measurement recorded.
inline constexpr struct Tuning {
  // Tables (docs/reference/limits.md).
  std::size_t longest_line = 1'000'000;  ///< bytes; by hand
  std::size_t most_columns = 10'000;     ///< by hand
  std::size_t most_words = 4'000'000;    ///< 40 bytes each in memory; by hand

  // Sampling.
  double longest_silence_s = 30.0 * 86400.0;  ///< within a log; then a clock was set; by hand
  std::size_t most_rows_per_sample = 1000;    ///< a higher rate is a mistake; by hand
  std::size_t most_rows = 10'000'000;         ///< of samples: 11 days at 10 Hz; by hand
  double joined_gap_s = 60.0;                 ///< between joined logs; by hand

  /// The clock of a table's rows.
  struct Clock {
    double slowest_hz = 0.01;          ///< of rows; by hand
    double fastest_hz = 1e5;           ///< by hand
    double longest_step_s = 1.1;       ///< of rows in another unit than s; by hand
    double longest_memory_s = 300.0;   ///< of velocities, until half is forgotten; by hand
    double least_whole_step_s = 0.9;   ///< of whole numbers that may count ms; by hand
    double since_1970_s = 1e8;         ///< numbers beyond tell their unit by their size; by hand
    double near_step_s = 60.0;         ///< distance from an hour, a day, a week; by hand
    double longest_step_back_s = 1.0;  ///< that is sorted without a word; by hand
  } clock;

  /// Velocities that are not measured.
  struct Validity {
    double rounding = 1e-4;        ///< of a mark, as a share: logs have four digits; by hand
    double far = 3.0;              ///< of a mark from zero, in sizes of the farthest other; by hand
    std::size_t least_marks = 3;   ///< of a value that nobody knows as a mark; by hand
    double most_merit = 0.4;       ///< [m/s] of a figure of merit: Water Linked's DVL A50
    double least_jump = 0.15;      ///< into and out of zeros, of the speeds' 90 % quantile; by hand
    std::size_t least_zeros = 3;   ///< rows; by hand
    std::size_t frozen_rows = 20;  ///< on one number; as the diagnosis has it
    std::size_t frozen_times = 4;  ///< times the longest usual repetition; likewise
    std::size_t moving_rows = 5;   ///< of another velocity, up to each change; likewise
    double usual_step = 0.9;       ///< quantile of changes from row to row; by hand
  } validity;

  /// Plausibility: in CSV logs of real and simulated vehicles ratios lie between 0.83 and 1.08
  /// where the correlation is 0.8 or more; in an autopilot's log at rest on a bench one is 0.38.
  struct Plausibility {
    std::array<double, 2> windows_s{1.0, 5.0};
    std::size_t least_rows = 5;      ///< of a window: by hand
    double least_windows = 20.0;     ///< by hand
    double longest_window = 1.5;     ///< of its usual length: by hand
    double least_correlation = 0.8;  ///< for a ratio that shows a mistake
    double unrelated = 0.5;          ///< in short windows, below: a shift is looked for
    double late_correlation = 0.65;  ///< at a shift that is a mistake, and …
    double late_gain = 0.4;          ///< … so much more than without; by hand
    double least_ratio = 0.6;
    double most_ratio = 1.7;
    double least_unknown = 0.2;  ///< of a ratio that no known unit explains: by hand
    double most_unknown = 5.0;
    double most_offset = 0.5;         ///< of a target's mean, in deviations of the slopes: by hand
    double usual_size = 0.75;         ///< quantile of the sizes of a velocity: by hand
    double fastest_turn_rad_s = 6.0;  ///< of a vehicle, without a word: a turn a second
    double fastest_m_s = 30.0;        ///< of a vehicle, likewise; by hand
    double certainly_too_fast = 3.0;  ///< times these: refused. Hovercraft turn at 13 rad/s
    double certain_clock = 500.0;     ///< ratios of all targets beyond tell of a clock; by hand
    double clock = 3.0;         ///< factor beside that of a clock where all are so large; by hand
    double near = 0.2;          ///< distance of a ratio from a known factor
    double most_late_s = 5.0;   ///< by hand
    double late_step_s = 0.25;  ///< by hand
    double most_repeated =
        0.3;  ///< share of rows with the stamp of the row before; a real log: 0.09
    double longest_gap_s = 600.0;  ///< without a word; by hand
    double gap_rows = 100.0;    ///< of usual steps in a gap, too: slow logs have no gaps; by hand
    double fastest_hz = 200.0;  ///< of rows, without a word; by hand
    double most_absurd = 2e-3;  ///< share of rows with values far beyond all others: by hand
    double absurd = 10.0;       ///< of the largest distance of all others: by hand
  } plausibility;

  /// Velocities beside the poses of the same log (check_pose()). By hand.
  struct PoseCheck {
    double least_windows = 12.0;
    double least_share = 0.7;         ///< of the ways, explained by velocities in some meaning
    double least_gain = 0.05;         ///< of a mirrored world
    double least_unexplained = 0.02;  ///< by velocities of the vehicle
    double clearer = 4.0;             ///< times less unexplained in another meaning
    double near_factor = 0.1;         ///< logarithm of a factor beside a unit's
    double least_turn_deg = 15.0;
    double least_correlation = 0.8;  ///< of the yaw rate and the slope of yaw
  } pose_check;

  /// The clock of the commands (command_clock_mistake()). By hand.
  struct CommandClock {
    double farthest_s = 30.0;
    double longest_part = 1.0 / 6.0;  ///< of the log, in a shift
    double near_s = 3.0;              ///< of thrusters, filters and feedback; no clock
    std::array<double, 4> lags_s{3.0, 6.0, 12.0, 24.0};  ///< of thrusters, together
    double step_s = 1.0;                                 ///< of the shifts
    double finer = 5.0;                                  ///< times, of the shift that was found
    double least_s = 180.0;                              ///< of the log
    std::size_t most_blocks = 20'000;
    double least_filled = 0.5;              ///< of the rows of a block
    std::size_t rows_per_coefficient = 10;  ///< in each half of the log
    double ridge = 1e-6;                    ///< of columns with unit variance
    double least_left = 1e-3;               ///< of a target: less is as good
    double least_gain = 0.2;                ///< logarithm; sound logs: up to 0.03
    double certain_gain = 0.5;              ///< from here on refused
    double agreement_s = 2.0;               ///< between the halves of the log
    double most_aligned_s = 10.0;           ///< that --align takes: Alignment::kMostS
  } command_clock;

  /// The window of a pose (find_pose_window()).
  struct PoseWindow {
    int pieces = 25;               ///< as the split `pieces`
    int folds = 5;                 ///< by hand
    double ridge = 1e-6;           ///< of columns with unit variance; by hand
    double least_steps = 3.5;      ///< half of the shortest window, in steps of the slowest source
    double windows = 40.0;         ///< at least so many halves in the log; by hand
    double rows_per_window = 8.0;  ///< more tell hardly more; by hand
    std::ptrdiff_t rows_per_coefficient = 4;  ///< by hand
    double least_gain = 1e-4;  ///< of R², where the commands explain nothing; by hand
  } pose_window;

  // Drafts (docs/howto/logs.md).
  double usual_rate_hz = 10.0;     ///< of rows; by hand
  double fastest_rate_hz = 50.0;   ///< of rows of a short log; by hand
  double wanted_rows = 1000.0;     ///< of a short log; by hand
  double few_rows = 300.0;         ///< below: a remark; by hand
  double longest_gap_s = 5.0;      ///< for commands sent on change; by hand
  double slow_hz = 4.9;            ///< thrusters answer within tenths of a second; by hand
  double farthest_stamps_s = 1.0;  ///< between the median offsets of two clocks; by hand
  double widest_stamps_s = 10.0;   ///< range of a clock's offset; by hand
  double least_motion = 0.1;       ///< heave's range, of the largest velocity's range; by hand
  double dead_band_us = 25.0;      ///< to both sides of rest: Blue Robotics, Basic ESC
  int rank_by_name = 5;            ///< of velocities known only by name; by hand
  int rank_other_system = 5;       ///< added for MAVLink messages of other senders; by hand
} kTuning{};

}  // namespace kelpie::log
