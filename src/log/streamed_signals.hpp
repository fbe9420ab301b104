// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "kelpie/stream/sample_stream.hpp"
#include "log/signal.hpp"

namespace kelpie::log {

/// What a SampleStream makes of whole signals, shown in the order of their stamps: its rows, as far
/// as all signals reach.
class StreamedSignals {
 public:
  /// `signals` are those of the plan's sources, sorted; they have to outlive it. The plan keeps all
  /// of their samples, and rows have its inputs. Throws InputError (from, or rate) as
  /// log::sample() does of a signal without samples, of a clock set ahead, of samples too far
  /// apart, of signals that never overlap and of too many rows.
  StreamedSignals(const StreamPlan& plan, const std::vector<Signal>& signals);

  /// All samples of a source, in its frame and without its lag.
  const SignalHistory& signal(std::size_t source) const { return stream_.signal(source); }

  std::vector<double> times_s;               ///< of the rows
  std::vector<std::vector<double>> columns;  ///< [input][row]; NaN where something is silent

 private:
  std::size_t next_to_show(const std::vector<std::size_t>& shown) const;
  void keep_rows(std::size_t most);
  void require_sound(std::size_t source) const;
  void end_with_the_first_to_end();

  SampleStream stream_;
  const std::vector<Signal>& signals_;
};

}  // namespace kelpie::log
