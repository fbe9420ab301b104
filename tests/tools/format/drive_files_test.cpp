// SPDX-License-Identifier: Apache-2.0
// The script that drives a vehicle is run under ArduPilot's bindings (ardupilot/run_script.lua).
#include "format/drive_files.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "support.hpp"

namespace kelpie::drive_files_test {
namespace {

using testing::TemporaryFolder;

constexpr int kArmed = 2500;   // ms
constexpr int kLatency = 110;  // ms, from arming to the first pulse
constexpr int kDelay = 10;     // ms, of a pulse: a run of the script, and its delay
constexpr int kHold = 310;     // ms, of a pulse without a further one
constexpr int kNoMotor = 0;    // function of an output that is missing

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

// A surge, a turn and a surge astern of two motors, on channels 0 and 8; 4.5 s.
format::PlannedDrive a_drive() {
  format::PlannedDrive drive = of_motors({"m1", "m9"});
  drive.plan.manoeuvres = {{"ahead", {{2.0, {0.5, 0.5}}, {0.5, {0.0, 0.0}}}},
                           {"turn", {{1.0, {1.5, -0.25}}}},
                           {"astern", {{1.0, {-0.5, -0.5}}}}};
  return drive;
}

struct Row {
  int t_ms;
  std::array<int, 2> pulses;
};

constexpr std::array<Row, 4> kDriven{
    {{0, {1700, 1700}}, {2000, {1500, 1500}}, {2500, {1900, 1400}}, {3500, {1300, 1300}}}};
constexpr int kEnd = 4500;
constexpr std::array<int, 2> kRest{1500, 1500};

/// What the script did on a vehicle.
class ScriptRun : public ::testing::Test {
 protected:
  void SetUp() override {
    if (std::system("command -v lua5.3 >/dev/null") != 0) {  // NOLINT: the test's own words
      GTEST_SKIP() << "no lua5.3";
    }
  }

  // Events as in run_script.lua; fails where ArduPilot would end the script.
  void run(const format::PlannedDrive& drive, const std::string& events, int missing = kNoMotor) {
    const TemporaryFolder folder;
    testing::write_text(folder / "plan.lua", format::drive_lua(drive));
    const std::string command =
        "lua5.3 '" KELPIE_SOURCE_DIR "/tests/tools/format/ardupilot/run_script.lua' '" +
        (folder / "plan.lua").string() + "' 12000 " + std::to_string(missing) + " " + events +
        " >'" + (folder / "out").string() + "'";
    ASSERT_EQ(std::system(command.c_str()), 0);  // NOLINT: the command is the test's own
    std::ifstream lines(folder / "out");
    for (std::string line; std::getline(lines, line);) {
      read(line);
    }
  }

  // The pulse on a channel; none: the autopilot's.
  std::optional<int> pulse(int channel, int t_ms) const {
    std::optional<int> last;
    for (const Change& change : changes_) {
      last = change.channel == channel && change.t_ms <= t_ms ? change.pulse : last;
    }
    return last;
  }

  std::array<std::optional<int>, 2> pulses(int t_ms) const {
    return {pulse(0, t_ms), pulse(8, t_ms)};
  }

  // The time of the first pulse from a time on; -1: none.
  int first_pulse(int from_ms) const {
    const auto found = std::ranges::find_if(
        changes_, [&](const Change& change) { return change.t_ms >= from_ms && change.pulse; });
    return found == changes_.end() ? -1 : found->t_ms;
  }

  void expect_driven_from(int began) const {
    for (std::size_t i = 0; i < kDriven.size(); ++i) {
      const int next = i + 1 < kDriven.size() ? kDriven[i + 1].t_ms : kEnd;
      const std::array<std::optional<int>, 2> wanted{kDriven[i].pulses[0], kDriven[i].pulses[1]};
      EXPECT_EQ(pulses(began + kDriven[i].t_ms + kDelay), wanted) << kDriven[i].t_ms;
      EXPECT_EQ(pulses(began + next - 1), wanted) << next;
    }
  }

  // At rest from a time on, and then the autopilot's.
  void expect_ended_by(int t_ms) const {
    const std::array<std::optional<int>, 2> rest{kRest[0], kRest[1]};
    EXPECT_EQ(pulses(t_ms), rest);
    EXPECT_EQ(pulses(t_ms + kHold), (std::array<std::optional<int>, 2>{}));
  }

  std::string said_;  // a line per text

 private:
  struct Change {
    int t_ms;
    int channel;
    std::optional<int> pulse;
  };

  void read(const std::string& line) {
    std::istringstream words(line);
    int t_ms = 0;
    std::string channel;
    std::string pulse;
    words >> t_ms >> channel >> pulse;
    if (channel == "text") {
      said_ += words.str().substr(line.find("kelpie")) + "\n";
    } else {
      changes_.push_back({t_ms, std::stoi(channel),
                          pulse == "released" ? std::nullopt : std::optional(std::stoi(pulse))});
    }
  }

  std::vector<Change> changes_;
};

TEST_F(ScriptRun, PulsesComeAtTheTimesOfThePlanAndEndAtRest) {
  run(a_drive(), "2500=arm");
  const int began = first_pulse(0);
  ASSERT_GE(began, kArmed);
  EXPECT_LE(began, kArmed + kLatency);
  expect_driven_from(began);
  expect_ended_by(began + kEnd + kDelay);
  EXPECT_EQ(first_pulse(began + kEnd + kDelay), -1);  // an armed vehicle isn't driven again
  EXPECT_EQ(said_,
            "kelpie plan: begins when armed\nkelpie plan: begins\nkelpie plan: at its end\n");
}

TEST_F(ScriptRun, DisarmingStopsAndArmingBeginsAnew) {
  run(a_drive(), "2500=arm 5600=disarm 6500=arm");
  expect_ended_by(5600 + 50 + kDelay);
  EXPECT_EQ(first_pulse(5600 + 50 + kDelay), first_pulse(6500));
  const int again = first_pulse(6500);
  EXPECT_LE(again, 6500 + kLatency);
  expect_driven_from(again);
  expect_ended_by(again + kEnd + kDelay);
  EXPECT_NE(said_.find("kelpie plan: stopped\nkelpie plan: begins when armed\n"), std::string::npos)
      << said_;
}

// After a restart of scripting under way nobody expects the motors to run.
TEST_F(ScriptRun, AVehicleArmedAlreadyIsNotDriven) {
  run(a_drive(), "0=arm 3000=disarm 4000=arm");
  EXPECT_GE(first_pulse(0), 4000);
  expect_driven_from(first_pulse(0));
}

TEST_F(ScriptRun, AMotorWithoutAnOutputIsToldAndNothingDriven) {
  run(a_drive(), "2500=arm", 82);
  EXPECT_EQ(first_pulse(0), -1);
  EXPECT_NE(said_.find("kelpie plan: no SERVOn_FUNCTION is 82\n"), std::string::npos) << said_;
}

// The autopilot has the motors during a pause; the drive goes on in its time.
TEST_F(ScriptRun, APauseOfTheScriptLetsGo) {
  run(a_drive(), "2500=arm 3100=pause");
  const int began = first_pulse(0);
  EXPECT_EQ(pulses(3100 + kHold), (std::array<std::optional<int>, 2>{}));
  EXPECT_EQ(pulses(4100 + kDelay), (std::array<std::optional<int>, 2>{1700, 1700}));
  EXPECT_EQ(pulses(began + 2500 + kDelay), (std::array<std::optional<int>, 2>{1900, 1400}));
  expect_ended_by(began + kEnd + kDelay);
}

// ArduPilot ends a script that takes more instructions than SCR_VM_I_COUNT, 10000 by default.
TEST_F(ScriptRun, TwoMinutesOfEightMotorsAreLoadedByDefault) {
  format::PlannedDrive drive = of_motors({"m1", "m2", "m3", "m4", "m5", "m6", "m7", "m8"});
  for (int i = 0; i < 240; ++i) {
    drive.plan.manoeuvres.push_back(
        {"binary", {{0.5, std::vector<double>(8, i % 2 == 0 ? 0.3 : -0.3)}}});
  }
  EXPECT_NE(format::drive_lua(drive).find("SCR_VM_I_COUNT 10000 or more"), std::string::npos);
  run(drive, "2500=arm");
  EXPECT_GE(first_pulse(0), kArmed);
  while (drive.plan.manoeuvres.size() < 1200) {
    drive.plan.manoeuvres.push_back(drive.plan.manoeuvres.back());
  }
  EXPECT_NE(format::drive_lua(drive).find("SCR_VM_I_COUNT 14612 or more"), std::string::npos);
}

}  // namespace
}  // namespace kelpie::drive_files_test
