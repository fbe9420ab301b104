// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "kelpie/stream/stream_plan.hpp"
#include "log/dataset.hpp"
#include "log/pose_window_search.hpp"
#include "log/signal.hpp"
#include "log/topic_alignment.hpp"

namespace kelpie::log {

/// Plan of a table at a common rate: a plan of a stream, and the estimation of open lags. Inputs
/// and targets have no effect here: a table has all columns.
struct SamplingPlan : StreamPlan {
  std::vector<std::string> responses;  ///< sources or derived columns for the estimation of lags
  double lag_part =
      0.5;  ///< share of the rows used for the estimation of lags, from the beginning …
  std::size_t lag_rows = 1600;  ///< … but no more than so many
  bool with_instants = false;   ///< Samples::instants are wanted
};

/// Result of sampling.
struct SamplingReport {
  /// Faults of a signal and their treatment.
  struct OfSource {
    std::string name;
    std::string from;
    double rate_hz = 0.0;
    SignalFaults faults;
    double lag_s = 0.0;
    std::string lag_origin;  ///< "", "given", "estimated", "estimated, common"
  };
  /// A derivative.
  struct OfDerived {
    std::string name;
    DerivativeInfo info;  ///< at the source's median step
  };
  std::vector<OfSource> sources;
  std::vector<OfDerived> derived;
  double pose_half_s = 0.0;                  ///< half of the pose's window; 0: no pose
  std::optional<PoseWindowChoice> window{};  ///< how the window was found; empty: given
  std::optional<TopicAlignment> lags;
  double lag_until_s = 0.0;  ///< end of the rows used for the estimation of lags
  double rate_hz = 0.0;      ///< of the rows
  std::size_t rows = 0;
  std::size_t whole_rows = 0;  ///< with a value in every column
  std::size_t segments = 0;    ///< stretches of whole rows
};

/// A log at a common rate.
struct Samples {
  Table table;       ///< columns t [s], sources, derived; NaN where something is silent
  Table instants{};  ///< pose_instants() where the plan wants these
  SamplingReport report;
};

/// The columns of a sampled table besides t: sources without positions and quaternions of a pose,
/// then derivatives and the pose's columns.
std::vector<std::string> sampled_columns(const StreamPlan& plan);

/// Feeds signals to a SampleStream in the order of stamps, and collects the rows up to the end of
/// the first signal to end. A pose's open window is found first, then open lags, in the rows up to
/// `lag_part`. `signals` belong to
/// plan.sources, in order, in seconds of a common clock; messages call the log `source`. Throws
/// InputError (source, then name, topic or field): as SampleStream and align_topics() do; a signal
/// without a finite value; a step back in time longer than the gap, or a step ahead longer than 30
/// days (a clock was set); signals without common time; a state with all samples farther apart than
/// the gap; components of a vector in different messages; too few samples in the window of a
/// derivative; more than 1000 rows per sample.
Samples sample(const SamplingPlan& plan, std::vector<Signal> signals, const std::string& source);

}  // namespace kelpie::log
