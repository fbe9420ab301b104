// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "kelpie/model/open_loop.hpp"
#include "kelpie/model/rollout.hpp"
#include "kelpie/model/trained_model.hpp"
#include "log/dataset.hpp"
#include "study/split.hpp"

namespace kelpie::study {

/// Rows of a log that follow each other without a break, first and one past the last.
struct Stretch {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// The stretches that lie in `rows`: neighbouring rows of one configuration, no more than three
/// usual steps of time apart, over which no state jumps by more than four usual accelerations
/// beyond what its target says (where a log was cut). Requires a state per target.
std::vector<Stretch> unbroken_stretches(const log::Dataset& data, std::span<const std::size_t> rows,
                                        std::span<const std::size_t> states);

/// The rows of a stretch from which rollouts start: the first, and the first so long after each.
std::vector<std::size_t> starts_in(const log::Dataset& data, const Stretch& stretch,
                                   double every_s);

/// The first row of the stretch so long after the start; its end if there is none.
std::size_t row_after(const log::Dataset& data, const Stretch& stretch, std::size_t start,
                      double seconds);

/// How far off velocities are so long after the start, over all starts. One number per state.
struct HorizonScore {
  double seconds = 0.0;
  std::size_t starts = 0;
  std::vector<double> r2;   ///< NaN with fewer than two starts
  std::vector<double> rms;  ///< root mean square error, unit of the velocity
  std::vector<double>
      covered;          ///< share of errors within 1.645 spreads and noise of the measurement
  double beyond = 0.0;  ///< share of the starts whose rollout ever left what was seen
};

/// Position error of dead reckoning over how far the vehicle went, for one length of an outage.
struct ReckoningScore {
  double seconds = 0.0;
  std::size_t outages = 0;
  double median = 0.0;  ///< of error / distance
  double most = 0.0;    ///< its 95 % quantile
};

/// How one contender did.
struct OpenLoopScore {
  std::string name;
  std::vector<HorizonScore> horizons;
  std::vector<ReckoningScore> reckoning;  ///< empty where the states aren't u, v, r
};

/// What is asked of every contender.
struct OpenLoopStudy {
  std::vector<double> horizons_s{1.0, 5.0, 10.0, 40.0};
  std::vector<double> outages_s{10.0, 30.0, 60.0};
  double start_every_s = 1.0;  ///< from one start to the next
  RolloutSettings rollout{};
  std::function<bool(double share)> keep_going{};  ///< asked now and then; may be empty
};

/// One model, in open loop from everywhere in the stretches from where a horizon fits in.
/// Dead reckoning: while the velocity log is silent the yaw rate is still measured; surge and sway
/// are rolled out, and position and heading come from integrating them.
OpenLoopScore score_open_loop(const std::string& name, const OpenLoop& model,
                              const log::Dataset& data, std::span<const Stretch> stretches,
                              const OpenLoopStudy& study);

/// One rollout beside what was measured.
struct Trajectory {
  std::vector<std::size_t> states;
  std::vector<double> time_s;                 ///< since its start
  std::vector<std::vector<double>> measured;  ///< [state][row]; empty where nothing was
  std::vector<std::vector<double>> velocity;  ///< [state][row]
  std::vector<std::vector<double>> spread;    ///< [state][row]
  std::vector<bool> beyond;                   ///< outside what was seen in learning
};

/// A rollout from one row to another, both included. Requires begin < end < rows.
Trajectory roll_out(const OpenLoop& model, const log::Dataset& data, std::size_t begin,
                    std::size_t end, const RolloutSettings& settings);

/// Everything that `kelpie rollout` finds.
struct OpenLoopResult {
  std::string source;    ///< the log
  std::string model;     ///< file
  std::string split;     ///< where the judged rows come from
  std::size_t rows = 0;  ///< judged
  std::size_t stretches = 0;
  double fade_s = 0.0;
  bool held = false;  ///< commands; else along a line
  std::vector<std::string> states;
  std::vector<std::string> units;     ///< of the states, "" where not known
  std::vector<OpenLoopScore> scores;  ///< the model first
  Trajectory example;
  double example_start_s = 0.0;  ///< in the log's time
};

/// What costs nothing: every state stays what it was.
OpenLoop hold_velocity(const OpenLoop& like);

/// What open-loop accuracy is measured of.
struct OpenLoopContender {
  std::string name;
  OpenLoop loop;
};

/// The model as `loop` rolls it out; the learned model alone, where `loop` fades into the steady
/// part after `fade_s`; recursive least squares trained on the same rows in their order, where the
/// velocities are the first inputs; and the velocity held.
std::vector<OpenLoopContender> open_loop_contenders(const TrainedModel& model, const OpenLoop& loop,
                                                    const log::Dataset& data, const Split& split,
                                                    double fade_s);

/// Fills in the result's example: of the rollouts over the longest horizon, begun every ten
/// seconds, the one whose velocities move most.
void add_example(OpenLoopResult& result, const OpenLoop& loop, const log::Dataset& data,
                 std::span<const Stretch> stretches, const OpenLoopStudy& study);

}  // namespace kelpie::study
