// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "kelpie/stream/sample_stream.hpp"
#include "log/signal.hpp"

namespace kelpie::log {

/// Rows that a SampleStream makes of whole signals, fed in the order of stamps, up to the end of
/// the first signal to end.
class StreamedSignals {
 public:
  /// `signals` belong to the plan's sources, are sorted, and have to outlive the object. The plan
  /// keeps all samples; rows have the plan's inputs. Throws InputError (from, or rate) on a signal
  /// without samples, a clock set ahead, samples too far apart, signals without common time, and
  /// too many rows, as sample() does.
  StreamedSignals(const StreamPlan& plan, const std::vector<Signal>& signals);

  /// All samples of a source, in the body frame, unshifted.
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
