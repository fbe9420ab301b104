// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace kelpie {

/// How a signal is taken between its samples.
enum class Between {
  line,  ///< on the straight line: measured states
  hold,  ///< the last value: commands
};

/// What became of a sample that was shown.
enum class Heard {
  used,
  no_value,  ///< NaN or infinite
  no_stamp,  ///< its time is NaN, or so far from 0 that no row can be told by it
  repeated,  ///< the stamp of a sample that is there
  late,      ///< what it would have been used for has been made without it
};

/// What was found wrong with a signal. Times are stamps, as shown.
struct SignalFaults {
  std::size_t samples = 0;        ///< that are used
  std::size_t no_value = 0;       ///< Heard::no_value: left out, as the next three are
  std::size_t no_stamp = 0;       ///< Heard::no_stamp
  std::size_t duplicates = 0;     ///< Heard::repeated
  std::size_t late = 0;           ///< Heard::late
  std::size_t steps_back = 0;     ///< put into the order of time
  std::size_t gaps = 0;           ///< silences longer than the gap given
  double longest_gap_s = 0.0;     ///< the longest silence, whether or not it counts as gap
  double longest_gap_at_s = 0.0;  ///< its beginning
  std::size_t stuck = 0;          ///< stretches of one value all along, longer than the gap
  double longest_stuck_s = 0.0;
  double longest_stuck_at_s = 0.0;
};

/// The last samples of one signal, in the order of time, and what was wrong with all of them. What
/// is stuck is counted and stays: a vehicle at rest looks the same.
/// Memory: 16 bytes per sample kept; nothing allocates after construction.
class SignalHistory {
 public:
  /// Keeps the last `keep` samples, one or more. They come `lag_s` late: a sample stamped
  /// t + lag_s belongs to time t, and all times below are such. Nothing bridges a silence longer
  /// than `gap_s`.
  SignalHistory(std::size_t keep, double lag_s, double gap_s);

  /// Shows a sample. Cost: O(1) in order; where it belongs before k others, O(k).
  Heard add(double stamp_s, double value);

  /// What lies up to `t` has been made use of: samples for it come too late from now on.
  void close(double t);

  /// The value at `t`. NaN before the first sample kept, after the last, and where no sample is
  /// near enough. (A held value lasts up to `gap_s` beyond its sample.) Cost: O(log keep).
  double at(double t, Between between) const;

  std::size_t size() const { return size_; }                         ///< samples kept
  double time_s(std::size_t i) const { return times_s_[place(i)]; }  ///< of the i-th kept
  double value(std::size_t i) const { return values_[place(i)]; }    ///< The same.
  std::size_t first_after(double t) const;     ///< the first kept with a time above `t`, or size()
  double begin_s() const { return begin_s_; }  ///< of the first since reset(); +inf: none
  double newest_s() const;                     ///< of the last; -inf: none
  double newest_stamp_s() const { return newest_stamp_s_; }  ///< The same, as it was shown.
  double lag_s() const { return lag_s_; }                    ///< As constructed.
  const SignalFaults& faults() const { return faults_; }     ///< Since construction.
  /// Whether its value hasn't changed for longer than the gap, though samples come.
  bool is_stuck() const { return stretch_counted_; }
  /// Whether a value in `from_s` to `until_s` is one of the stretch that it is stuck in, or was
  /// last.
  bool was_stuck(double from_s, double until_s) const {
    return from_s <= stuck_end_s_ && until_s > stuck_begin_s_;
  }

  void count_no_stamp() { ++faults_.no_stamp; }  ///< A sample without a time was shown.
  void reset();                                  ///< Forgets the samples, not the faults.

 private:
  static constexpr double kNever = -std::numeric_limits<double>::infinity();

  std::size_t place(std::size_t i) const {
    const std::size_t at = first_ + i;
    return at < times_s_.size() ? at : at - times_s_.size();
  }
  void insert(std::size_t at, double t, double value);
  void note_in_order(double stamp_s, double value);

  double lag_s_;
  double gap_s_;
  std::vector<double> times_s_;  // rings
  std::vector<double> values_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
  double begin_s_ = -kNever;
  double newest_stamp_s_ = kNever;
  double closed_s_ = kNever;
  double stretch_value_ = 0.0;  // of equal values, up to now
  double stretch_begin_s_ = 0.0;
  std::size_t stretch_samples_ = 0;
  bool stretch_counted_ = false;  // as stuck
  double stuck_begin_s_ = -kNever;
  double stuck_end_s_ = kNever;
  SignalFaults faults_;
};

}  // namespace kelpie
