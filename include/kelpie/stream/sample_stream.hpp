// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "kelpie/stream/signal_history.hpp"
#include "kelpie/stream/stream_plan.hpp"

namespace kelpie {

/// One row of a SampleStream.
struct SampleRow {
  double t = 0.0;             ///< [s], a whole multiple of 1 / rate
  std::span<const double> x;  ///< the inputs of the plan; NaN for a silent source
  std::span<const double> y;  ///< the targets of the plan, likewise
  bool is_whole = false;      ///< no NaN: a sample for learning
};

/// Makes samples from messages, one by one, as a StreamPlan says: frames, lever arm, lags,
/// interpolation, derivatives (docs/howto/logs.md).
///
/// The first row is made when every source has delivered. A row is emitted, in time order, as soon
/// as every source has a sample at or after the time of the row (centred derivatives: half a window
/// later). A silent source delays a row only until the newest stamp of all sources is `wait_s`
/// later than the last useful stamp. While all sources are silent for longer than the gap, no rows
/// are made.
///
/// The same messages in the order of their stamps give the same rows as a log of these messages, to
/// the bit. Later messages are dropped and counted. After eight consecutive messages per source
/// with stamps older than gap and wait, a clock was set, and the stream restarts.
///
/// Memory: 16 bytes per stored sample, twice for velocities with an attitude or a lever arm, and 32
/// per sample of the source with the largest `keep`. Allocates and throws at construction only.
class SampleStream {
 public:
  static constexpr double kRounding = 1e-6;  ///< [rows] tolerance of the first sample's time

  /// Throws InputError as StreamPlan::validate(), and for a plan without sources or inputs, a lag
  /// to be estimated, a source with keep = 0.
  explicit SampleStream(const StreamPlan& plan);
  SampleStream(SampleStream&& other) noexcept;
  SampleStream& operator=(SampleStream&& other) noexcept;
  ~SampleStream();

  /// Processes a sample of a source, by the place of the source in the plan. Call next() until no
  /// row is left. Cost: O(1) for samples in order.
  SignalVerdict feed(std::size_t source, double stamp_s, double value);

  /// The next complete row or nullptr; valid until the next call. Cost: O(sources log keep), and
  /// O(window degree) per derivative of a row.
  const SampleRow* next();

  /// Marks the end of the messages: next() gives the remaining rows. A later feed() starts over.
  void finish();

  const StreamPlan& plan() const;                         ///< As constructed.
  const SignalHistory& signal(std::size_t source) const;  ///< State of a source.
  /// Time since the newest sample of a source, by the newest stamp of all sources [s]; +inf without
  /// a sample.
  double silent_s(std::size_t source) const;
  /// Whether the row at `t` uses samples of a source from a stretch in which the source was stuck.
  /// Valid after next() has returned this row.
  bool is_stuck(std::size_t source, double t) const;
  std::size_t restarts() const;  ///< Number of restarts after a jump of the clock.

  /// Whether a sample with this stamp restarts the stream. A caller with a time origin of its own
  /// then calls begin_anew() and feeds the sample with a new stamp.
  bool begins_anew_with(double stamp_s) const;
  void begin_anew();  ///< Restarts: all samples and unfinished rows are dropped.

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace kelpie
