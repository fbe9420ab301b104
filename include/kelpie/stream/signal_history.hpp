// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace kelpie {

/// Interpolation of a signal between samples.
enum class Interpolation {
  line,   ///< linear: measured states
  hold,   ///< the last value: commands
  curve,  ///< cubic, by slopes over two neighbours (Catmull & Rom 1974): measured states that a
          ///< line would flatten; linear beside a gap
};

/// Result of add() for a sample.
enum class SignalVerdict {
  used,
  no_value,  ///< NaN or infinite
  no_stamp,  ///< the stamp is NaN or too large for a row number
  repeated,  ///< same stamp as a stored sample
  late,      ///< after close() of the time of the sample
};

/// Faults of a signal. Times are stamps as given.
struct SignalFaults {
  std::size_t samples = 0;        ///< used samples
  std::size_t no_value = 0;       ///< SignalVerdict::no_value: dropped, like the next three
  std::size_t no_stamp = 0;       ///< SignalVerdict::no_stamp
  std::size_t duplicates = 0;     ///< SignalVerdict::repeated
  std::size_t late = 0;           ///< SignalVerdict::late
  std::size_t steps_back = 0;     ///< samples sorted into the time order
  std::size_t gaps = 0;           ///< silences longer than the configured gap
  double longest_gap_s = 0.0;     ///< the longest silence, gap or not
  double longest_gap_at_s = 0.0;  ///< start of this silence
  std::size_t stuck = 0;          ///< stretches of a constant value, longer than the gap
  double longest_stuck_s = 0.0;
  double longest_stuck_at_s = 0.0;
};

/// The last samples of a signal in time order, and statistics of faults of all samples. Samples of
/// a stuck signal are counted and kept, because a vehicle at rest has the same readings. Memory: 16
/// bytes per stored sample. Allocates at construction only.
class SignalHistory {
 public:
  /// Stores the last `keep` samples, at least 1. A sample stamped t + lag_s has the time t; all
  /// times below are without the lag. No interpolation over silences longer than `gap_s`.
  SignalHistory(std::size_t keep, double lag_s, double gap_s);

  /// Inserts a sample. Cost: O(1) in order, O(k) before k newer samples.
  SignalVerdict add(double stamp_s, double value);

  /// Marks all times up to `t` as used: later samples for these times are late.
  void close(double t);

  /// The value at `t`. NaN before the first stored sample, after the last, and in gaps. (A held
  /// value is valid for `gap_s`.) Cost: O(log keep).
  double at(double t, Interpolation between) const;

  std::size_t size() const { return size_; }                         ///< stored samples
  double time_s(std::size_t i) const { return times_s_[place(i)]; }  ///< of stored sample i
  double value(std::size_t i) const { return values_[place(i)]; }    ///< of stored sample i
  std::size_t first_after(double t) const;     ///< first stored sample later than `t`, or size()
  double begin_s() const { return begin_s_; }  ///< of the first sample since reset(); +inf without
  double newest_s() const;                     ///< of the last sample; -inf without
  double newest_stamp_s() const { return newest_stamp_s_; }  ///< newest_s() as a stamp
  double lag_s() const { return lag_s_; }                    ///< As constructed.
  const SignalFaults& faults() const { return faults_; }     ///< Since construction.
  /// Whether the value of new samples has been constant for longer than the gap.
  bool is_stuck() const { return stretch_counted_; }
  /// Whether `from_s` to `until_s` overlaps with the current or last stuck stretch.
  bool was_stuck(double from_s, double until_s) const {
    return from_s <= stuck_end_s_ && until_s > stuck_begin_s_;
  }

  void count_no_stamp() { ++faults_.no_stamp; }  ///< Counts a sample without a time.
  void reset();                                  ///< Drops the samples, keeps the faults.

 private:
  double on_curve(double t, std::size_t after) const;
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
