// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "kelpie/stream/stream_plan.hpp"
#include "log/dataset.hpp"
#include "log/signal.hpp"
#include "log/topic_alignment.hpp"

namespace kelpie::log {

/// What a table at one common rate is made of: the plan of a stream, and how lags that it leaves
/// open are estimated. Its inputs and targets don't matter here: a table has all columns.
struct SamplingPlan : StreamPlan {
  std::vector<std::string> responses;  ///< sources or derived that lags are estimated from
  double lag_part = 0.5;               ///< lags are estimated from this first share of the rows …
  std::size_t lag_rows = 1600;         ///< … but no more than so many
};

/// What was done to the signals.
struct SamplingReport {
  /// What was found in a signal, and done to it.
  struct OfSource {
    std::string name;
    std::string from;
    double rate_hz = 0.0;
    SignalFaults faults;
    double lag_s = 0.0;
    std::string lag_origin;  ///< "", "given", "estimated", "estimated, common"
  };
  /// What a derivative was taken with.
  struct OfDerived {
    std::string name;
    DerivativeInfo info;  ///< at the source's median step
  };
  std::vector<OfSource> sources;
  std::vector<OfDerived> derived;
  std::optional<TopicAlignment> lags;
  double lag_until_s = 0.0;  ///< end of the rows that lags were estimated from
  double rate_hz = 0.0;      ///< of the rows
  std::size_t rows = 0;
  std::size_t whole_rows = 0;  ///< with a value in every column
  std::size_t segments = 0;    ///< stretches of whole rows
};

/// A log at one common rate.
struct Samples {
  Table table;  ///< columns t [s], sources, derived; NaN where something is silent
  SamplingReport report;
};

/// Shows signals to a SampleStream in the order of their stamps, and keeps its rows, as far as all
/// signals reach. Twice where lags are to be estimated: without them, then with them.
/// `signals` are those of plan.sources, in their order, in seconds of one clock; `source` is what
/// messages call the log. Throws InputError (source, then name, topic or field): what
/// SampleStream and align_topics() refuse; a signal without a finite value, or with a step back in
/// time longer than the gap or a step ahead longer than 30 days, which are clocks set anew; signals
/// that never overlap in time; a state whose samples are all farther apart than the gap; components
/// of a vector that come in different messages; too few samples in the window of a derivative; more
/// than 1000 rows per sample.
Samples sample(const SamplingPlan& plan, std::vector<Signal> signals, const std::string& source);

}  // namespace kelpie::log
