// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "file/json.hpp"
#include "study/result.hpp"

namespace kelpie::fleet {

inline constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

/// Figures of a learner on an axis, and of simple predictors on the same rows. NaN for a figure
/// that does not exist.
enum class Measure : std::size_t {
  r2_final,  ///< final R² on held-out rows
  r2_mean,   ///< mean R² on held-out rows over the stream
  one_step,  ///< R² one step ahead
  coverage,  ///< share of samples inside their interval
  least_squares_final,
  least_squares_one_step,
  mean_final,
  mean_one_step,
  last_value_one_step,
};
inline constexpr std::size_t kMeasures = 9;

/// Outcome of a run on an axis.
struct AxisOutcome {
  std::string name;
  std::string unit;
  std::array<double, kMeasures> values{};

  double operator[](Measure measure) const { return values[static_cast<std::size_t>(measure)]; }
};

/// Measured times. They differ between repetitions of a run.
struct Times {
  double seconds = 0.0;     ///< of the whole run
  double update_us = 0.0;   ///< median of the model's updates, all axes together
  double p99_us = 0.0;      ///< 99th percentile of the same
  double share = kNoValue;  ///< of real time, spent in updates; NaN for a log without a rate
};

/// Outcome of a combination of log, split and learner.
struct Outcome {
  std::string alignment;  ///< alignment of the commands, in words
  std::size_t training_rows = 0;
  std::size_t held_out_rows = 0;
  double duration_s = 0.0;  ///< of the log
  std::size_t memory_bytes = 0;
  std::vector<std::string> findings;  ///< changes of the vehicle, in words (howto/diagnosis.md)
  std::string left;                   ///< what the thrusters can do after them, in words
  std::vector<AxisOutcome> axes;
  Times times;
};

/// Outcome of a complete stream with baselines, alignment and diagnosis; `times.seconds` is left
/// at 0.
Outcome outcome_of(const study::StreamResult& stream, double duration_s);

file::Json outcome_json(const Outcome& outcome);  ///< About 1 kB; docs/howto/studies.md.
/// Throws InputError on JSON of another form than outcome_json()'s.
Outcome read_outcome(const file::JsonNode& node);

double number_or_none(const file::JsonNode& node);  ///< NaN for null. Throws as number().

}  // namespace kelpie::fleet
