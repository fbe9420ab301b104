// SPDX-License-Identifier: Apache-2.0
#include "lab/diagnosis_study.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "simulator/scenario_file.hpp"

namespace kelpie::diagnosis_study_test {
namespace {

simulator::Scenario scenario() {
  return simulator::read_scenario(std::filesystem::path(KELPIE_SOURCE_DIR) /
                                  "scenarios/diagnosis.toml");
}

lab::DiagnosisRun run_of(std::size_t index, const lab::DiagnosisCase& of) {
  lab::DiagnosisRun run;
  run.of = index;
  run.seed = 1;
  run.found = true;
  run.named_after_s = 12.0;
  run.finding.state = FindingState::named;
  run.finding.count = of.truth.size();
  for (std::size_t i = 0; i < of.truth.size(); ++i) {
    run.finding.causes[i] = of.truth[i];
  }
  return run;
}

lab::DiagnosisStudy all_right() {
  lab::DiagnosisStudy study;
  study.cases = lab::diagnosis_cases(scenario().vehicle);
  study.seeds = 1;
  study.first_seed = 1;
  study.after_s = 60.0;
  for (std::size_t i = 0; i < study.cases.size(); ++i) {
    study.runs.push_back(run_of(i, study.cases[i]));
  }
  study.nominal = {{.seed = 1, .hours = 24.0}};
  return study;
}

TEST(DiagnosisStudy, EveryCaseIsAVehicleThatCanBeDriven) {
  simulator::Scenario driven = scenario();
  std::set<std::string> names;
  for (const lab::DiagnosisCase& of : lab::diagnosis_cases(driven.vehicle)) {
    driven.configurations[1] = of.configuration;
    EXPECT_NO_THROW(driven.validate()) << of.name;
    EXPECT_TRUE(names.insert(of.name + std::to_string(of.effect)).second) << of.name;
    ASSERT_FALSE(of.truth.empty());
  }
}

TEST(DiagnosisStudy, OnlyTheWholeTruthIsRight) {
  const lab::DiagnosisStudy study = all_right();
  for (const lab::DiagnosisRun& right : study.runs) {
    const lab::DiagnosisCase& of = study.cases[right.of];
    EXPECT_TRUE(named_rightly(of, right)) << of.name;
    EXPECT_TRUE(holds_truth(of, right)) << of.name;
    lab::DiagnosisRun wrong = right;
    wrong.finding.causes[0].kind =
        of.truth[0].kind == CauseKind::drag ? CauseKind::load : CauseKind::drag;
    EXPECT_FALSE(named_rightly(of, wrong)) << of.name;
    wrong = right;
    wrong.finding.count = 3 - right.finding.count;
    EXPECT_FALSE(named_rightly(of, wrong)) << of.name;
    wrong = right;
    wrong.finding.state = FindingState::ambiguous;
    EXPECT_FALSE(named_rightly(of, wrong)) << of.name;
    wrong = right;
    wrong.finding.causes[0].lower = wrong.finding.causes[0].size + 0.1;
    EXPECT_FALSE(holds_truth(of, wrong)) << of.name;
  }
}

TEST(DiagnosisStudy, SaysTheSameInTableAndJson) {
  lab::DiagnosisStudy study = all_right();
  study.runs[0].finding.state = FindingState::none;
  const std::vector<lab::CaseSummary> all = lab::summaries(study);
  EXPECT_EQ(all[0].right, 0U);
  EXPECT_EQ(all[1].right, 1U);
  EXPECT_EQ(all[1].median_s, 12.0);
  const auto json = nlohmann::json::parse(lab::diagnosis_json(study));
  ASSERT_EQ(json["runs"].size(), study.runs.size());
  EXPECT_EQ(json["runs"][0]["said"], "none of these");
  EXPECT_EQ(json["runs"][1]["right"], true);
  EXPECT_NE(lab::diagnosis_table(study).find("thruster th1"), std::string::npos);
  EXPECT_EQ(json["runs"][0]["kind"], "thruster");
}

}  // namespace
}  // namespace kelpie::diagnosis_study_test
