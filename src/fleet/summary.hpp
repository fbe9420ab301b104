// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fleet/outcome.hpp"
#include "fleet/results.hpp"
#include "fleet/trend.hpp"

namespace kelpie::fleet {

/// Quantiles over runs, which are logs with a split; NaN without any.
struct Spread {
  std::size_t runs = 0;  ///< that have such a figure
  double least = kNoValue;
  double tenth = kNoValue;  ///< the 10th percentile
  double median = kNoValue;
  double ninetieth = kNoValue;  ///< the 90th percentile
};
Spread spread_of(std::vector<double> values);  ///< Of the finite ones.

/// How often one is better than another by more than kClearly of R² on held-out rows, and worse.
struct Duel {
  std::size_t better = 0;
  std::size_t worse = 0;
};

/// What a learner does on one axis of a vehicle, over all its runs.
struct LearnerSummary {
  Spread r2_final;
  Spread r2_mean;
  Spread one_step;
  Spread coverage;
  Duel least_squares;
  Duel mean;
  std::size_t best = 0;  ///< runs where no learner and no baseline is clearly better
  Spread shortfall;      ///< of R² on held-out rows to the best of them, 0 or more
};

/// The vehicle's axis of a name.
struct AxisSummary {
  std::string name;
  std::string unit;
  std::vector<LearnerSummary> learners;  ///< as Plan::learners
  Spread least_squares;                  ///< R² on held-out rows, at the end
  Spread mean;
  Spread least_squares_one_step;
  Spread last_value_one_step;
  Trend trend;  ///< of the first learner with the first split, R² on held-out rows at the end
};

/// What a learner took.
struct LearnerTimes {
  Spread update_us;
  Spread p99_us;
  Spread share;  ///< of real time
  Spread memory_bytes;
};

/// What became of a vehicle in a mission, by name, as the first learner found it.
struct MissionFindings {
  std::size_t mission = 0;
  std::vector<std::string> findings;
};

/// All that is said of a vehicle.
struct VehicleSummary {
  std::string name;
  std::size_t missions = 0;
  std::size_t failed = 0;              ///< combinations without an outcome
  double hours = 0.0;                  ///< of logs that were learned
  std::vector<AxisSummary> axes;       ///< in the order in which they came
  std::vector<LearnerTimes> learners;  ///< as Plan::learners
  std::vector<MissionFindings> findings;
};

/// A learner over all vehicles and axes. A run on one axis counts as one.
struct LearnerOverall {
  std::size_t judged = 0;  ///< runs' axes
  std::size_t best = 0;    ///< as LearnerSummary has it
  Duel least_squares;
  Duel mean;
  Spread shortfall;
  LearnerTimes times;
};

/// A run of the first learner on one axis, and what a simple predictor has there.
struct RunScore {
  std::size_t combination = 0;
  std::string axis;
  double r2 = kNoValue;
  double least_squares = kNoValue;
  double mean = kNoValue;
};

/// What a study says.
struct StudySummary {
  std::vector<VehicleSummary> vehicles;
  std::vector<LearnerOverall> learners;  ///< as Plan::learners
  std::vector<RunScore> worst;  ///< the least R² on held-out rows first; none at all before that
  std::size_t trends = 0;       ///< that were tested
  double seconds = 0.0;         ///< of all jobs
};
inline constexpr std::size_t kWorstRuns = 50;

/// Reads the outcomes once, vehicle by vehicle. Memory: some numbers of the runs of one vehicle,
/// and one per mission and axis. Throws Failure where they can't be read.
StudySummary summarise(const Results& results);

}  // namespace kelpie::fleet
