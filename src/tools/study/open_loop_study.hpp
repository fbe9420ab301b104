// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kelpie/model/open_loop.hpp"
#include "kelpie/model/rollout.hpp"
#include "kelpie/model/trained_model.hpp"
#include "log/dataset.hpp"
#include "study/split.hpp"

namespace kelpie::study {

/// Consecutive rows of a log without a break: the first row, and the row after the last.
struct Stretch {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// The stretches within `rows`: neighbouring rows of one configuration, at most three usual time
/// steps apart. A cut in the log ends a stretch: a jump of a state beyond the target by more than
/// four usual accelerations and by more than ten standard deviations of the noise of velocity.
/// Requires a state per target.
std::vector<Stretch> unbroken_stretches(const log::Dataset& data, std::span<const std::size_t> rows,
                                        std::span<const std::size_t> states);

/// The start rows of rollouts in a stretch of rows at `times_s`: the first row, then a row every
/// `every_s` seconds.
std::vector<std::size_t> starts_in(std::span<const double> times_s, const Stretch& stretch,
                                   double every_s);

/// The first row at least `seconds` after the start; the end of the stretch without such a row.
std::size_t row_after(const log::Dataset& data, const Stretch& stretch, std::size_t start,
                      double seconds);

/// Errors of velocities at a horizon after the start, over every start. One number per state.
struct HorizonScore {
  double seconds = 0.0;
  std::size_t starts = 0;
  std::vector<double> r2;   ///< NaN with fewer than two starts
  std::vector<double> rms;  ///< root mean square error, unit of the velocity
  std::vector<double>
      covered;          ///< share of errors within 1.645 spreads and noise of the measurement
  double beyond = 0.0;  ///< share of rollouts that left the range seen in learning
};

/// Position error of dead reckoning relative to the travelled distance, for one outage length.
struct ReckoningScore {
  double seconds = 0.0;
  std::size_t outages = 0;
  double median = 0.0;  ///< of error / distance
  double most = 0.0;    ///< 95 % quantile of error / distance
};

/// Scores of one contender.
struct OpenLoopScore {
  std::string name;
  std::vector<HorizonScore> horizons;
  std::vector<ReckoningScore> reckoning;  ///< empty where the states aren't u, v, r
};

/// Options of score_open_loop().
struct OpenLoopStudy {
  std::vector<double> horizons_s{1.0, 5.0, 10.0, 40.0};
  std::vector<double> outages_s{10.0, 30.0, 60.0};
  double start_every_s = 1.0;  ///< from one start to the next
  RolloutSettings rollout{};
  std::function<bool(double share)> keep_going{};  ///< called now and then; may be empty
};

/// Rolls one model out from every start in the stretches, over every horizon that fits.
/// Dead reckoning: during an outage of the velocity log the yaw rate is still measured; surge and
/// sway are rolled out, then integrated to position and heading.
OpenLoopScore score_open_loop(const std::string& name, const OpenLoop& model,
                              const log::Dataset& data, std::span<const Stretch> stretches,
                              const OpenLoopStudy& study);

/// One rollout beside the measurement.
struct Trajectory {
  std::vector<std::size_t> states;
  std::vector<double> time_s;                 ///< since the start
  std::vector<std::vector<double>> measured;  ///< [state][row]; empty without a measurement
  std::vector<std::vector<double>> velocity;  ///< [state][row]
  std::vector<std::vector<double>> spread;    ///< [state][row]
  std::vector<bool> beyond;                   ///< outside the range seen in learning
};

/// A rollout from one row to another, both included. Requires begin < end < rows.
Trajectory roll_out(const OpenLoop& model, const log::Dataset& data, std::size_t begin,
                    std::size_t end, const RolloutSettings& settings);

/// The result of `kelpie rollout`.
struct OpenLoopResult {
  std::string source;    ///< the log
  std::string model;     ///< file
  std::string split;     ///< source of the scored rows
  std::size_t rows = 0;  ///< scored rows
  std::size_t stretches = 0;
  bool held = false;  ///< commands held between rows; else linear
  std::vector<std::string> states;
  std::vector<std::string> units;     ///< of the states; "": unknown
  std::vector<OpenLoopScore> scores;  ///< the model first
  Trajectory example;
  double example_start_s = 0.0;  ///< time in the log
};

/// The trivial predictor: every state keeps its value.
OpenLoop hold_velocity(const OpenLoop& like);

inline constexpr std::string_view kVelocityHeld = "velocity held";  ///< of hold_velocity()

/// A predictor in open loop.
struct OpenLoopContender {
  std::string name;
  OpenLoop loop;
};

/// The model in `loop`; the learned model alone and its equations of motion alone; recursive least
/// squares trained on the same rows in time order, if the velocities are the first inputs; and the
/// velocity held.
std::vector<OpenLoopContender> open_loop_contenders(const TrainedModel& model, const OpenLoop& loop,
                                                    const log::Dataset& data, const Split& split);

/// Fills in the result's example: the rollout over the longest horizon with a start, started every
/// ten seconds, with the largest motion of the velocities. Requires a score.
void add_example(OpenLoopResult& result, const OpenLoop& loop, const log::Dataset& data,
                 std::span<const Stretch> stretches, const OpenLoopStudy& study);

/// Position [m] and heading [rad] from surge, sway and yaw rate, by the middle of each step.
struct Pose {
  double x = 0.0;
  double y = 0.0;
  double heading = 0.0;

  void advance(double surge, double sway, double yaw, double dt_s) {
    const double middle = heading + 0.5 * yaw * dt_s;
    x += (surge * std::cos(middle) - sway * std::sin(middle)) * dt_s;
    y += (surge * std::sin(middle) + sway * std::cos(middle)) * dt_s;
    heading += yaw * dt_s;
  }
};

}  // namespace kelpie::study
