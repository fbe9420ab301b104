// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "kelpie/motion/diagnosis.hpp"
#include "lab/diagnosis_cases.hpp"
#include "vehicle/scenario.hpp"

namespace kelpie::lab {

/// A study of the diagnosis on the simulated vehicle.
struct DiagnosisPlan {
  vehicle::Scenario scenario;  ///< vehicle, noise, excitation and rate; one configuration
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

}  // namespace kelpie::lab
