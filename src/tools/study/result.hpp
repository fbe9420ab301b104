// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kelpie/alignment/alignment.hpp"
#include "kelpie/svr/regressor.hpp"
#include "kelpie/vehicle/diagnosis.hpp"
#include "study/baselines.hpp"
#include "study/coverage.hpp"

namespace kelpie::study {

/// State of a learner at one point of the stream.
struct ValidationPoint {
  std::size_t samples = 0;  ///< training samples shown so far
  double time_s = 0.0;      ///< time of the last shown sample
  double r2 = 0.0;          ///< on the held-out rows of the current configuration
  int configuration = 0;
  Status status;  ///< buffer, support vectors, totals of every node
  /// Coefficients of AxisResult::terms, in target units per unit of the term; empty without a model
  /// in service.
  std::vector<double> coefficients{};
  std::vector<double> errors{};  ///< standard errors of the coefficients; NaN: unknown
};

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// A physics term of a learner, and the scale by which its coefficient is judged.
struct TermInfo {
  std::string formula;      ///< an Expression (motion/expression.hpp)
  std::string unit;         ///< of the coefficient, e.g. "m rev^-2"; empty: unknown
  double rms = 0.0;         ///< root mean square over the shown training rows, in the term's unit
  double error = kUnknown;  ///< standard error of the coefficient at the end; NaN: unknown
};

/// Predictions of the held-out rows of a configuration at the end of a stage. A stage is a run of
/// training rows of one configuration; the vehicle changes, or the stream ends, after a stage.
struct StageEnd {
  int configuration = 0;
  std::size_t samples = 0;  ///< training samples shown so far
  double r2 = 0.0;
  std::vector<double> time_s;  ///< of the held-out rows, in the order of time
  std::vector<double> truth;   ///< in the target's unit
  std::vector<double> predicted;
};

/// A change of the vehicle that a learner detected, after which the old model was replaced.
struct ChangeFound {
  std::size_t samples = 0;    ///< training samples shown so far
  double time_s = 0.0;        ///< time of the last shown sample
  double since_s = 0.0;       ///< start of the growth of errors
  std::int64_t recalled = 0;  ///< number of the recalled past model, or 0
  std::size_t withdrawn = 0;  ///< training samples shown at its withdrawal; 0: the change stands
};

/// A step with samples rejected as outliers, or with an implausible sample.
struct OutliersFound {
  std::size_t samples = 0;  ///< training samples shown so far, this sample included
  double time_s = 0.0;      ///< time of this sample
  double target = 0.0;      ///< measured target of this sample
};

/// All measurements of one axis over one stream. Lists are in the order of the stream. R² is NaN
/// where not defined.
struct AxisResult {
  std::string name;                         ///< the target column
  std::string unit;                         ///< of the target; empty: unknown
  std::vector<MemberShare> members;         ///< of the mixture, at the end
  std::vector<TermInfo> terms;              ///< empty without coefficients
  std::vector<ValidationPoint> validation;  ///< the last point is at the end of the stream
  std::vector<StageEnd> stages;
  std::vector<ChangeFound> changes;
  std::vector<OutliersFound> outliers;
  double r2_final = 0.0;
  double r2_mean = 0.0;                    ///< over the validation points with a model in service
  double r2_min_after_1000 = 0.0;          ///< NaN with fewer than 1,000 samples
  double prequential_r2 = 0.0;             ///< one step ahead: prediction before learning
  OneStep one_step;                        ///< the predictions one step ahead
  Coverage coverage;                       ///< of the intervals of one_step
  double corrected_r2 = 0.0;               ///< one step ahead, disturbance included
  OneStep corrected;                       ///< the predictions with the disturbance
  Coverage corrected_coverage;             ///< of the intervals of corrected
  Baselines baselines;                     ///< simple predictors on the same rows
  std::vector<double> update_us;           ///< time of each update, microseconds
  std::vector<double> held_out_time_s;     ///< held-out rows of all configurations, time order
  std::vector<double> held_out_true;       ///< in the target's unit
  std::vector<double> held_out_predicted;  ///< by the model at the end of the stream
  /// Error against novelty, on the held-out rows of the last configuration.
  std::vector<NoveltyBin> novelty;
  Status status;  ///< at the end of the stream
};

/// Named changes of the vehicle, and the state of the thrusters at the end.
struct DiagnosisResult {
  std::string why_not;            ///< why no diagnosis was possible; empty: diagnosis ran
  bool has_reference = true;      ///< else there were too few rows to compare with
  std::vector<Finding> findings;  ///< in the order of time
  std::vector<Cause> health;      ///< of every thruster; empty before the reference is complete
  std::vector<Cause> present{};   ///< shares of the nominal thrust; empty before a reference
  std::optional<Authority> authority{};  ///< at the end, with the commands driven; empty: unknown
};

/// One stream from start to end (or to the interruption). result_fields.hpp lists the numbers.
struct StreamResult {
  std::string source;  ///< path of the log
  std::size_t rows_read = 0;
  std::size_t rows_skipped = 0;  ///< NaN or infinite rows
  double rate_hz = 0.0;
  std::vector<std::string> input_names;
  std::vector<std::string> commands{};  ///< the inputs that are commands; empty: not known
  std::string split;                    ///< label, e.g. "blocks of 400 rows, every 5th held out"
  std::string from;                     ///< file of the continued model; empty: a new model
  std::string nominal{};                ///< files of what was known beforehand; empty: nothing
  std::string scales;                   ///< source of the scaling, e.g. "first 200 samples"
  AlignmentResult alignment;            ///< of commands; empty `why`: not requested
  CurrentResult current;                ///< of the water; empty `why`: not looked for
  std::uint64_t seed = 0;
  std::size_t training_rows = 0;
  std::size_t held_out_rows = 0;
  double memory_s = 0.0;  ///< in which the quickest velocity forgets half of itself; 0: unknown
  /// Held-out stretches in whole memories: how much of the motion training rows do not tell.
  double judging_memories = std::numeric_limits<double>::infinity();
  std::vector<std::string> answers{};  ///< inputs that copy a velocity or target, in words
  std::size_t samples_shown = 0;       ///< < training_rows after an interruption
  bool interrupted = false;
  std::size_t memory_bytes = 0;                               ///< of all learners; 0: unknown
  std::vector<std::pair<std::string, std::string>> settings;  ///< name and value, in table order
  DiagnosisResult diagnosis;
  std::vector<AxisResult> axes;
};

}  // namespace kelpie::study
