// SPDX-License-Identifier: Apache-2.0
#include "report/next_steps.hpp"

#include <gtest/gtest.h>

#include <string>

#include "report/synthetic.hpp"

namespace kelpie::next_steps_test {
namespace {

constexpr double kChange = 100.0;  // s

std::string first_command(const Cause& cause) {
  study::StreamResult result = synthetic::stream(2);
  for (int row = 0; row < 600; ++row) {
    result.axes.front().one_step.time_s.push_back(kChange + 0.25 * row);
  }
  Finding finding;
  finding.since_s = kChange;
  finding.state = FindingState::named;
  finding.count = 1;
  finding.causes[0] = cause;
  result.diagnosis.findings = {finding};
  return report::after_learning(result, {"dive.csv", "", ""}, "model.json").front().command;
}

TEST(NextSteps, AChangedVehicleIsLearnedAlone) {
  const std::string command = "kelpie learn dive.csv --since 100 --out out/since";
  EXPECT_EQ(first_command({CauseKind::thruster, 4, 0.6, 0.55, 0.65}), command);
  EXPECT_EQ(first_command({CauseKind::drag, 0, 1.02, 0.99, 1.05}), command);
}

TEST(NextSteps, TheLogKeepsItsOptions) {
  study::StreamResult result = synthetic::stream(2);
  const auto first = [&](const report::LogWords& log) {
    return report::after_learning(result, log, "model.json").front().command;
  };
  EXPECT_EQ(first({"'a dive.csv'", " --align none", " --rate 4"}),
            "kelpie rollout 'a dive.csv' --rate 4 --model model.json");
}

std::string commands_of(const study::StreamResult& result, const report::LogWords& log) {
  std::string text;
  for (const report::NextStep& step : report::after_learning(result, log, "model.json")) {
    text += step.command + "\n";
  }
  return text;
}

TEST(NextSteps, AnotherLogIsReadAsThisOne) {
  EXPECT_EQ(commands_of(synthetic::stream(2),
                        {"dive.csv", {}, " --rate 4 --split tail", " --rate 4 --units r=deg/s"}),
            "kelpie rollout dive.csv --rate 4 --split tail --model model.json\n"
            "kelpie predict LOG --rate 4 --units r=deg/s --model model.json\n"
            "kelpie learn LOG --rate 4 --units r=deg/s --from model.json\n");
}

// `kelpie rollout` needs velocities, and rows to judge by.
TEST(NextSteps, NoCommandIsToldThatWouldBeRefused) {
  study::StreamResult result = synthetic::stream(2);
  EXPECT_EQ(commands_of(result, {.file = "dive.csv"}).find("rollout"), std::string::npos);
  result.diagnosis.why_not = "no velocities are known";
  EXPECT_EQ(commands_of(result, {"dive.csv", {}, ""}).find("rollout"), std::string::npos);
}

// The rows before the damage are of the same vehicle.
TEST(NextSteps, AThrusterThatIsBackLeavesNoRowsOut) {
  EXPECT_EQ(first_command({CauseKind::thruster, 4, 0.99, 0.97, 1.01}),
            "kelpie rollout dive.csv --model model.json");
}

std::string first_step(study::StreamResult result, const Cause& one, const Cause& other,
                       FindingState state = FindingState::ambiguous) {
  Finding finding;
  finding.state = state;
  finding.count = 1;
  finding.causes[0] = one;
  finding.rival = other;
  result.diagnosis.findings = {finding};
  return report::after_learning(result, {.file = "dive.csv", .planning = " --rate 4"}, "model.json")
      .front()
      .command;
}

TEST(NextSteps, ADriveTellsTwoCausesApart) {
  const study::StreamResult result = synthetic::stream(3);
  const auto plan = [](const std::string& causes) {
    return "kelpie plan dive.csv --rate 4 --apart " + causes;
  };
  using enum CauseKind;
  EXPECT_EQ(first_step(result, {thruster, 4, 0.6}, {drag, 1}), plan("th2,sway_drag --change 40"));
  EXPECT_EQ(first_step(result, {drag, 1, 2.5}, {thruster, 4}), plan("sway_drag,th2 --change 100"));
  EXPECT_EQ(first_step(result, {all_thrusters, 0, 0.9}, {load, 0}),
            plan("all_thrusters,load --change 10"));
  EXPECT_EQ(first_step(result, {force, 0}, {force, 2}), plan("surge_force,yaw_moment"));
}

TEST(NextSteps, NoDriveIsToldThatWouldBeRefused) {
  using enum CauseKind;
  const auto has_plan = [](const std::string& command) { return command.find("plan") < 10; };
  const study::StreamResult result = synthetic::stream(3);
  EXPECT_FALSE(has_plan(first_step(result, {thruster, 4}, {sensor_bias, 0})));
  EXPECT_FALSE(has_plan(first_step(result, {frozen, 1}, {drag, 1})));
  EXPECT_FALSE(has_plan(first_step(result, {drag, 1}, {drag, 1})));
  EXPECT_FALSE(has_plan(first_step(result, {thruster, 4}, {drag, 1}, FindingState::named)));
  study::StreamResult rudder = result;
  rudder.input_names.back() = "rudder";
  EXPECT_FALSE(has_plan(first_step(rudder, {thruster, 4}, {drag, 1})));
  study::StreamResult heave = result;
  heave.input_names[1] = "w";
  EXPECT_FALSE(has_plan(first_step(heave, {thruster, 4}, {drag, 0})));
}

}  // namespace
}  // namespace kelpie::next_steps_test
