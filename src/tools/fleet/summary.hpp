// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fleet/outcome.hpp"
#include "fleet/results.hpp"
#include "fleet/trend.hpp"

namespace kelpie::fleet {

/// Quantiles of a figure over runs (a log with a split each); NaN without runs.
struct Spread {
  std::size_t runs = 0;  ///< number of runs with the figure
  double least = kNoValue;
  double tenth = kNoValue;  ///< the 10th percentile
  double median = kNoValue;
  double ninetieth = kNoValue;  ///< the 90th percentile
};
Spread spread_of(std::vector<double> values);  ///< Of the finite values.

/// Number of runs with final R² on held-out rows better, and worse, than a rival's by more than
/// kTuning.clear_difference.
struct Duel {
  std::size_t better = 0;
  std::size_t worse = 0;
};

/// A learner on an axis of a vehicle, over all runs.
struct LearnerSummary {
  Spread r2_final;
  Spread r2_mean;
  Spread one_step;
  Spread coverage;
  Duel least_squares;
  Duel mean;
  std::size_t best = 0;  ///< runs without a clearly better learner or baseline
  Spread shortfall;      ///< distance to the best final R² on held-out rows, >= 0
};

/// An axis of a vehicle.
struct AxisSummary {
  std::string name;
  std::string unit;
  std::vector<LearnerSummary> learners;  ///< as Plan::learners
  Spread least_squares;                  ///< final R² on held-out rows
  Spread mean;
  Spread least_squares_one_step;
  Spread last_value_one_step;
  Trend trend;  ///< final R² on held-out rows of the first learner with the first split
};

/// Costs of a learner.
struct LearnerTimes {
  Spread update_us;
  Spread p99_us;
  Spread share;  ///< of real time
  Spread memory_bytes;
};

/// Changes of a vehicle during a mission, as found by the first learner.
struct MissionFindings {
  std::size_t mission = 0;
  std::vector<std::string> findings;
  std::string left;  ///< as in Outcome
};

/// Summary of a vehicle.
struct VehicleSummary {
  std::string name;
  std::size_t missions = 0;
  std::size_t failed = 0;              ///< combinations without an outcome
  double hours = 0.0;                  ///< of learned logs
  std::vector<AxisSummary> axes;       ///< in the order of their first runs
  std::vector<LearnerTimes> learners;  ///< as Plan::learners
  std::vector<MissionFindings> findings;
};

/// A learner over all vehicles and axes. A run counts once per axis.
struct LearnerOverall {
  std::size_t judged = 0;  ///< runs' axes
  std::size_t best = 0;    ///< as LearnerSummary::best
  Duel least_squares;
  Duel mean;
  Spread shortfall;
  LearnerTimes times;
};

/// Final R² on held-out rows of the first learner's run on an axis, and of baselines.
struct RunScore {
  std::size_t combination = 0;
  std::string axis;
  double r2 = kNoValue;
  double least_squares = kNoValue;
  double mean = kNoValue;
};

/// Summary of a study.
struct StudySummary {
  std::vector<VehicleSummary> vehicles;
  std::vector<LearnerOverall> learners;  ///< as Plan::learners
  std::vector<RunScore> worst;           ///< runs without R² first, then the lowest R²
  std::size_t trends = 0;                ///< number of tested trends
  double seconds = 0.0;                  ///< of all jobs
};

/// Reads the outcomes once, vehicle by vehicle. Memory: some numbers per run of one vehicle, and a
/// number per mission and axis. Throws Failure if an outcome cannot be read.
StudySummary summarise(const Results& results);

}  // namespace kelpie::fleet
