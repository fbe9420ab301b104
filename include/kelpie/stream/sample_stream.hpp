// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "kelpie/stream/derivative.hpp"
#include "kelpie/stream/sample_queue.hpp"
#include "kelpie/stream/signal_history.hpp"
#include "kelpie/stream/stream_plan.hpp"

namespace kelpie {

/// One row of a SampleStream.
struct SampleRow {
  double t = 0.0;             ///< [s], a whole multiple of 1 / rate
  std::span<const double> x;  ///< the plan's inputs; NaN where something is silent
  std::span<const double> y;  ///< its targets, alike
  bool is_whole = false;      ///< a value everywhere: a sample to learn from
};

/// Messages in, samples out, one by one: frames, lever arm, lags, lines or holds, derivatives, as a
/// StreamPlan has it (docs/from_topics.md). Rows begin when every source has been heard, and come
/// in the order of time, each as soon as all it takes has come: of every source a sample at its
/// time or later (centred derivatives: half a window later); or, where a source is silent, when the
/// newest stamp of any source is `wait_s` beyond what could still have been of use. Where all
/// sources are silent for longer than the gap there are no rows.
/// The same messages in the order of their stamps give the same rows, to the bit, as a log of them.
/// What comes too late for that is left out and counted. When all that comes lies further back than
/// gap and wait, for eight messages per source on end, a clock was set: the stream begins anew.
/// Memory: 16 bytes per sample kept, twice for velocities with an attitude or a lever arm, and 32
/// per sample of the source that keeps most. After construction nothing allocates and nothing
/// throws.
class SampleStream {
 public:
  static constexpr double kRounding = 1e-6;  ///< of a row: so near the first sample is a row

  /// Throws InputError: what StreamPlan::validate() refuses, a plan without sources or inputs, a
  /// lag that is still to be estimated, a source that keeps nothing.
  explicit SampleStream(const StreamPlan& plan);

  /// Shows a sample of a source, by its place in the plan. Call next() until it has no row.
  /// Requires a source that is one. Cost: O(1) in order.
  Heard feed(std::size_t source, double stamp_s, double value);

  /// The next row if it is complete, or nullptr; until the next call. Cost: O(sources log keep),
  /// and O(window degree) per derivative of a row.
  const SampleRow* next();

  /// Nothing more comes: next() gives the rows that still wait. What is fed afterwards begins anew.
  void finish();

  const StreamPlan& plan() const { return plan_; }  ///< As constructed.
  const SignalHistory& signal(std::size_t source) const {
    return signals_[source];
  }  ///< Its state.
  /// For how long a source has been silent, by the newest stamp of all [s]; +inf: all the time.
  double silent_s(std::size_t source) const;
  /// Whether the row at `t` takes something of a source from a stretch in which it was stuck, as
  /// far as is known: after next() has given that row.
  bool is_stuck(std::size_t source, double t) const;
  std::size_t restarts() const { return restarts_; }  ///< How often it had to begin anew.

  /// Whether a sample with this stamp makes it begin anew. Who counts times from elsewhere then
  /// calls begin_anew() and shows the sample with its new stamp.
  bool begins_anew_with(double stamp_s) const;
  void begin_anew();  ///< Forgets all samples; rows that wait are lost.

 private:
  // Where a source's samples go: frames are other signs, and in the world others' places.
  struct Route {
    std::size_t to = 0;
    double sign = 1.0;
  };
  struct Column {
    std::size_t source = 0;
    bool is_derived = false;
  };
  // A velocity's samples wait until the rates at their time are known.
  struct Arm {
    std::array<std::size_t, 3> velocity{};
    std::array<std::size_t, 3> rates{};
    Triple arm_m{};
    std::vector<SampleQueue> waiting;  // of the three velocities; none where there is no arm
  };

  // A vector of the world waits, all three of a message, until the attitude at their time is known.
  struct Turn {
    std::array<std::size_t, 3> velocity{};
    std::vector<std::size_t> attitude;  // three angles, or a quaternion
    double unit = 1.0;                  // of the angles [rad]
    Frame from = Frame::ned;
    Frame to = Frame::frd;
    std::vector<SampleQueue> waiting;  // of the three
  };

  void route_vectors();
  void use_turns();
  void use_arm();
  Column column(const std::string& name) const;
  void follow_clock(double stamp_s);
  bool is_behind(double stamp_s) const;
  void reset();
  bool begin();
  Heard take(std::size_t source, double stamp_s, double value);
  Heard take_of_body(std::size_t source, double stamp_s, double value);
  Triple body_of(const Turn& turn, const Triple& vector, double stamp_s) const;
  void settle_turns();
  void drop_first(Turn& turn);
  void settle_arm();
  void settle_first(std::size_t part);
  double complete_until_s(std::size_t source) const;
  bool is_known(std::size_t source, double t, Between between) const;
  bool is_known(double t) const;
  bool is_near_a_sample(double row) const;
  double next_sample_s(double t) const;
  double value(const Column& column, double t);
  void make_row(double t);

  StreamPlan plan_;
  std::vector<SignalHistory> signals_;
  std::vector<Route> routes_;
  Arm arm_;
  std::vector<Turn> turns_;
  std::vector<double> ahead_s_;    // how far derivatives look ahead, per source …
  std::vector<double> back_s_;     // … and back
  std::vector<Between> known_by_;  // as a line where there are derivatives
  std::vector<Column> columns_;    // inputs, then targets
  std::vector<double> values_;     // of a row
  Derivative derivative_;
  double clock_s_;  // newest stamp of all
  bool has_begun_ = false;
  double next_row_ = 0.0;  // as its multiple of 1 / rate
  SampleRow row_;
  std::size_t behind_ = 0;  // messages on end that lie far back
  std::size_t restarts_ = 0;
  bool is_finished_ = false;
};

}  // namespace kelpie
