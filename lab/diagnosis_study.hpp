// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "chart/text_table.hpp"
#include "kelpie/vehicle/diagnosis.hpp"
#include "simulator/scenario.hpp"

namespace kelpie::lab {

/// A change of the simulated vehicle, and the expected diagnosis.
struct DiagnosisCase {
  std::string name;  ///< without the strength: "thruster th1"
  int effect = 0;    ///< strength in percent; 0: without strength
  bool special =
      false;  ///< two causes, or a load off the centre: not in the table of single causes
  simulator::Configuration configuration;
  std::vector<Cause> truth;  ///< one or two; intervals unused
};

/// Every single cause with effects of 20, 40, 60 and 80 percent, and pairs of them:
///
///     thruster   th1, th2, th3: thrust reduced by the share
///     drag       surge, sway, yaw: linear and quadratic damping increased by the share
///     load       in the middle, neutral: inertia in surge increased by the share; also 0.2 m ahead
///     force      back in surge, and a tether at the stern: a share of the greatest thrust
///     scale      of u, v, r: readings increased by the share
///     bias       of u, v, r: a share of 0.25 m/s, 0.1 m/s, 0.2 rad/s
///     frozen     u, v, r
///     two        of 40 percent each
std::vector<DiagnosisCase> diagnosis_cases(const simulator::VehicleParameters& vehicle);

/// "thruster", "drag", … of a cause of the simulated vehicle, with its column or axis.
std::string case_name(const Cause& cause);

/// A study of the diagnosis on the simulated vehicle.
struct DiagnosisPlan {
  simulator::Scenario scenario;  ///< vehicle, noise, excitation and rate; one configuration
  std::size_t seeds = 20;
  std::uint64_t first_seed = 1;
  double before_s = 900.0;      ///< nominal, before the change; plus up to a random minute
  double after_s = 60.0;        ///< time for the diagnosis after the change
  double nominal_hours = 24.0;  ///< of driving without a change, for every fifth seed
  std::size_t threads = 0;      ///< 0: one per core
  std::function<bool(double)> keep_going = [](double) { return true; };  ///< with the share done
};

/// The diagnosis of a change at the end of a run.
struct DiagnosisRun {
  std::size_t of = 0;  ///< index of the case
  std::uint64_t seed = 0;
  bool found = false;
  double found_after_s = 0.0;  ///< of the change
  double named_after_s = 0.0;  ///< time of the final verdict
  /// Largest error of the share that is left of an axis, where thrusters alone changed; else NaN.
  double authority_error = std::numeric_limits<double>::quiet_NaN();
  Finding finding;
};

/// Driving without a change.
struct NominalRun {
  std::uint64_t seed = 0;
  double hours = 0.0;
  std::size_t named = 0;       ///< named changes, each an error
  std::size_t taken_back = 0;  ///< named changes withdrawn later
  std::size_t unnamed = 0;     ///< detected changes without a name
};

/// The results of a study.
struct DiagnosisStudy {
  std::vector<DiagnosisCase> cases;
  std::vector<DiagnosisRun> runs;
  std::vector<NominalRun> nominal;
  std::size_t seeds = 0;
  std::uint64_t first_seed = 0;
  double after_s = 0.0;
};

DiagnosisStudy study_diagnosis(const DiagnosisPlan& plan);  ///< Runs every case and seed.

/// Whether the run named the true causes and no more.
bool named_rightly(const DiagnosisCase& of, const DiagnosisRun& run);
/// Whether the intervals hold the true sizes. Requires named_rightly().
bool holds_truth(const DiagnosisCase& of, const DiagnosisRun& run);
/// The diagnosis in words: "thruster th1", "th1 and …", "one of two", "none of these", "nothing".
std::string said(const DiagnosisRun& run);

/// The results of a case over the seeds.
struct CaseSummary {
  std::size_t runs = 0;
  std::size_t right = 0;  ///< runs with the true causes named and no more
  std::size_t wrong = 0;  ///< runs with another name
  std::size_t held = 0;   ///< right runs with the true sizes inside the intervals
  double median_s = 0.0;  ///< from the change to the name, in right runs
  double longest_s = 0.0;
  double authority_error = 0.0;  ///< the largest of all runs; NaN: other causes
};
std::vector<CaseSummary> summaries(const DiagnosisStudy& study);  ///< In the order of the cases.

std::string diagnosis_table(const DiagnosisStudy& study);  ///< For a terminal.
std::string diagnosis_json(const DiagnosisStudy& study);   ///< docs/howto/diagnosis.md

}  // namespace kelpie::lab
