// SPDX-License-Identifier: Apache-2.0
#include "format/drive_files.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace kelpie::drive_files_test {
namespace {

format::PlannedDrive of_motors(const std::vector<std::string>& names) {
  format::PlannedDrive drive{.source = "log.csv", .thrusters = names};
  drive.plan.manoeuvres = {{"ahead", {{2.0, std::vector<double>(names.size(), 0.5)}}}};
  drive.command = [](std::size_t, double speed) { return 1500.0 + 400.0 * speed; };
  return drive;
}

// SERVOn_FUNCTION of ArduPilot: motors 1 to 8 are 33 to 40, motors 9 to 12 are 82 to 85.
TEST(DriveFiles, TheScriptDrivesTheOutputsOfTheMotors) {
  const format::PlannedDrive drive = of_motors({"m1", "m8", "m9", "m12"});
  ASSERT_TRUE(format::has_pulses(drive));
  const std::string script = format::drive_lua(drive);
  EXPECT_NE(script.find("local functions = {33, 40, 82, 85, }"), std::string::npos) << script;
}

TEST(DriveFiles, NoScriptDrivesAnOutputThatNoMotorOrAnotherOneHas) {
  EXPECT_FALSE(format::has_pulses(of_motors({"m1", "m13"})));
  EXPECT_FALSE(format::has_pulses(of_motors({"left1", "right1"})));
  EXPECT_FALSE(format::has_pulses(of_motors({"m1", "stern"})));
}

}  // namespace
}  // namespace kelpie::drive_files_test
