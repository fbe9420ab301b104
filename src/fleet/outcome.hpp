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

/// R² beyond which one learner is called better than another.
inline constexpr double kClearly = 0.01;

/// What a learner is judged by on one axis, and the same of simple predictors on the same rows. NaN
/// where there is no such figure.
enum class Measure : std::size_t {
  r2_final,  ///< R² on held-out rows, at the end
  r2_mean,   ///< … mean over the stream
  one_step,  ///< R² one step ahead
  coverage,  ///< share of samples inside their interval
  least_squares_final,
  least_squares_one_step,
  mean_final,
  mean_one_step,
  last_value_one_step,
};
inline constexpr std::size_t kMeasures = 9;

/// What came of one axis.
struct AxisOutcome {
  std::string name;
  std::string unit;
  std::array<double, kMeasures> values{};

  /// One of `values`.
  double operator[](Measure measure) const { return values[static_cast<std::size_t>(measure)]; }
};

/// Times, which no two runs have alike.
struct Times {
  double seconds = 0.0;     ///< of the whole job
  double update_us = 0.0;   ///< median of the model's updates, all axes together
  double p99_us = 0.0;      ///< … and the 99th percentile
  double share = kNoValue;  ///< of real time that updates take; NaN where the log has no rate
};

/// What came of a combination: of a log, a split and a learner.
struct Outcome {
  std::string alignment;  ///< how commands were shifted
  std::size_t training_rows = 0;
  std::size_t held_out_rows = 0;
  double duration_s = 0.0;  ///< of the log
  std::size_t memory_bytes = 0;
  std::vector<std::string> findings;  ///< what became of the vehicle, by name (docs/diagnosis.md)
  std::vector<AxisOutcome> axes;
  Times times;
};

/// Of a stream that ran to its end, with its baselines, alignment and diagnosis; but for
/// `times.seconds`.
Outcome outcome_of(const study::StreamResult& stream, double duration_s);

file::Json outcome_json(const Outcome& outcome);  ///< Some 1 kB; docs/study.md.
/// Throws InputError on what outcome_json() didn't write.
Outcome read_outcome(const file::JsonNode& node);

double number_or_none(const file::JsonNode& node);  ///< NaN for null. Throws as number().

}  // namespace kelpie::fleet
