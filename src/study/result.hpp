// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "kelpie/model/alignment_search.hpp"
#include "kelpie/motion/cause.hpp"
#include "kelpie/online/regressor.hpp"
#include "study/baselines.hpp"
#include "study/coverage.hpp"

namespace kelpie::study {

/// One look at a learner while the stream runs.
struct ValidationPoint {
  std::size_t samples = 0;  ///< training samples shown so far
  double time_s = 0.0;      ///< time of the last of them
  double r2 = 0.0;          ///< on the held-out rows of the configuration then running
  int configuration = 0;
  Status status;  ///< buffer, support vectors, totals of every node
  /// Of AxisResult::terms, in target units per unit of the term; none without a model in service.
  std::vector<double> coefficients{};
  std::vector<double> errors{};  ///< standard errors of these; NaN: not known
};

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// One of a learner's physics terms, and what its coefficient is to be measured by.
struct TermInfo {
  std::string formula;  ///< core/expression.hpp
  std::string unit;     ///< of the coefficient, e.g. "m rev^-2"; empty where it can't be told
  double rms = 0.0;     ///< root mean square over the training rows shown, in the term's own unit
  double error = kUnknown;  ///< standard error of the coefficient at the end; NaN: not known
};

/// What a learner said of a configuration's held-out rows at the end of one of its stages, a run of
/// training rows of that configuration: just before the vehicle changed, or at the stream's end.
struct StageEnd {
  int configuration = 0;
  std::size_t samples = 0;  ///< training samples shown until then
  double r2 = 0.0;
  std::vector<double> time_s;  ///< of the held-out rows, in the order of time
  std::vector<double> truth;   ///< in the target's own unit
  std::vector<double> predicted;
};

/// A learner found that the vehicle had changed, and forgot what it knew of it.
struct ChangeFound {
  std::size_t samples = 0;    ///< training samples shown until then
  double time_s = 0.0;        ///< of the last of them
  double since_s = 0.0;       ///< when errors began to grow
  std::int64_t recalled = 0;  ///< number of the past model taken up, or 0
  std::size_t withdrawn = 0;  ///< training samples shown when it was taken back; 0: it stands
};

/// A step at which samples were rejected as outliers, or the sample itself as implausible.
struct OutliersFound {
  std::size_t samples = 0;  ///< training samples shown until then, this one included
  double time_s = 0.0;      ///< of the last of them
  double target = 0.0;      ///< … and what was measured then
};

/// Everything measured of one axis over one stream.
struct AxisResult {
  std::string name;                         ///< the target column
  std::string unit;                         ///< of it; empty where none is given
  std::vector<MemberShare> members;         ///< of a committee, at the end
  std::vector<TermInfo> terms;              ///< none where the learner has, or had, no coefficients
  std::vector<ValidationPoint> validation;  ///< in the order of the stream; the last is at its end
  std::vector<StageEnd> stages;             ///< in the order of the stream
  std::vector<ChangeFound> changes;         ///< in the order of the stream
  std::vector<OutliersFound> outliers;      ///< in the order of the stream
  double r2_final = 0.0;
  double r2_mean = 0.0;                    ///< over the validation points with a model in service
  double r2_min_after_1000 = 0.0;          ///< NaN when fewer than 1,000 samples were shown
  double prequential_r2 = 0.0;             ///< one step ahead, each sample before it was learned
  OneStep one_step;                        ///< … and all of these predictions
  Coverage coverage;                       ///< of their intervals
  double corrected_r2 = 0.0;               ///< one step ahead with the disturbance
  OneStep corrected;                       ///< … all of these, as one_step
  Coverage corrected_coverage;             ///< of their intervals
  Baselines baselines;                     ///< simple predictors on the same rows
  std::vector<double> update_us;           ///< time of each update in stream order, microseconds
  std::vector<double> held_out_time_s;     ///< held-out rows, time order, all configurations
  std::vector<double> held_out_true;       ///< in the target's own unit
  std::vector<double> held_out_predicted;  ///< by the model at the end of the stream
  /// … and how good it was where, on the held-out rows of the configuration that ran at the end.
  std::vector<NoveltyBin> novelty;
  Status status;  ///< at the end of the stream
};

/// What became of the vehicle by name, and how its thrusters did at the end.
struct DiagnosisResult {
  std::string why_not;            ///< what a diagnosis would need; empty: there is one
  std::vector<Finding> findings;  ///< in the order of time
  std::vector<Cause> health;      ///< of every thruster; none before there is a reference
};

/// One stream from start to end (or to the interruption).
struct StreamResult {
  std::string source;  ///< the log's path
  std::size_t rows_read = 0;
  std::size_t rows_skipped = 0;  ///< NaN or infinite rows
  double rate_hz = 0.0;
  std::vector<std::string> input_names;
  std::string split;         ///< label, e.g. "blocks of 400 rows, every 5th held out"
  std::string from;          ///< the model it went on with; empty: it began anew
  std::string scales;        ///< where the scaling came from, e.g. "first 200 samples"
  AlignmentFound alignment;  ///< of commands; `why` is empty where nobody asked
  std::uint64_t seed = 0;
  std::size_t training_rows = 0;
  std::size_t held_out_rows = 0;
  std::size_t samples_shown = 0;  ///< < training_rows when interrupted
  bool interrupted = false;
  std::size_t memory_bytes = 0;  ///< of all learners; 0 where not known
  std::vector<std::pair<std::string, std::string>> settings;  ///< name and value, in table order
  DiagnosisResult diagnosis;
  std::vector<AxisResult> axes;
};

}  // namespace kelpie::study
