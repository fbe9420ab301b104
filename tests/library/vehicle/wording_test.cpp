// SPDX-License-Identifier: Apache-2.0
#include "kelpie/vehicle/diagnosis.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace kelpie::diagnosis_wording_test {
namespace {

const std::vector<std::string> kInputs{"u", "v", "r", "th1", "th2", "th3"};
const std::vector<std::string> kTargets{"udot", "vdot", "rdot"};
const DiagnosisNames kNames{kInputs, kTargets};

TEST(Wording, AThrustersShareWithItsInterval) {
  EXPECT_EQ(cause_text({CauseKind::thruster, 4, 0.48, 0.41, 0.55}, kNames),
            "th2 gives 48 % of its thrust (41 to 55 %)");
}

TEST(Wording, AThrusterThatHadChangedIsToldAgainstItsNominalThrust) {
  Finding finding;
  finding.state = FindingState::named;
  finding.count = 1;
  finding.causes[0] = {CauseKind::thruster, 4, 1.0, 0.97, 1.03};
  finding.before[0] = -0.0004;
  EXPECT_EQ(finding_text(finding, kNames),
            "th2 gives 100 % of its nominal thrust again (97 to 103 %; before 0 %)");
  finding.causes[0] = {CauseKind::thruster, 4, 0.3, 0.28, 0.32};
  finding.before[0] = 0.6;
  EXPECT_EQ(finding_text(finding, kNames),
            "th2 gives 30 % of its nominal thrust (28 to 32 %; before 60 %)");
}

TEST(Wording, AllThrustersAreNamedWithoutAColumn) {
  const Cause cause{CauseKind::all_thrusters, 0, 0.8, 0.78, 0.82};
  EXPECT_EQ(cause_text(cause, kNames), "all thrusters give 80 % of their thrust (78 to 82 %)");
  EXPECT_EQ(cause_column(cause, kNames), "");
}

TEST(Wording, NumbersHaveTheDigitsThatTheIntervalGives) {
  EXPECT_EQ(cause_text({CauseKind::sensor_bias, 0, 0.0512, 0.0493, 0.0531}, kNames),
            "u reads 0.0512 (0.0493 to 0.0531) too much");
  EXPECT_EQ(cause_text({CauseKind::drag, 1, 1.41, 1.2, 1.6}, kNames),
            "the drag in vdot is 1.41 (1.20 to 1.60) times what it was");
}

TEST(Wording, TwoCausesAreJoinedAndTwoRivalsSaid) {
  Finding finding;
  finding.state = FindingState::named;
  finding.count = 2;
  finding.causes[0] = {CauseKind::thruster, 3, 0.6, 0.5, 0.7};
  finding.causes[1] = {CauseKind::load, 0, 1.2, 1.1, 1.3};
  EXPECT_EQ(finding_text(finding, kNames),
            "th1 gives 60 % of its thrust (50 to 70 %), and its inertia is 1.20 (1.10 to 1.30) "
            "times what it was: a load has come");
  finding.state = FindingState::ambiguous;
  finding.rival = {CauseKind::thruster, 5, 0.7, 0.6, 0.8};
  EXPECT_EQ(finding_text(finding, kNames),
            "th1 gives 60 % of its thrust (50 to 70 %), or th3 gives 70 % of its thrust (60 to "
            "80 %): not excited enough to tell them apart. Drive th1 alone, or th3 alone");
}

}  // namespace
}  // namespace kelpie::diagnosis_wording_test
