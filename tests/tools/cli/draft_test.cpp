// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "bag/ardusub_drive.hpp"
#include "cli/command.hpp"

namespace kelpie::draft_command_test {
namespace {

using testing::content_of;
using testing::kelpie;
using testing::Outcome;

// A vehicle at 20 Hz without accelerations, its columns by other names than kelpie's.
std::string raw_log(const std::string& header) {
  std::string text = header + "\n";
  double u = 0.0;
  for (int k = 0; k < 3000; ++k) {
    const double n = std::sin(0.02 * k) + 0.5 * std::sin(0.071 * k);
    text += fmt::format("{},{},{}\n", 0.05 * k, u, n);
    u += 0.05 * (n - u * std::abs(u) - 0.3 * u);
  }
  return text;
}

class DraftCommand : public testing::CommandTest {
 protected:
  nlohmann::json axis(const std::string& folder) {
    return nlohmann::json::parse(content_of(folder_ / folder / "result.json"))["axes"][0];
  }
};

TEST_F(DraftCommand, ATemplateIsLearnedAsTheLogWithoutAConfiguration) {
  write("raw.csv", raw_log("seconds,surge_velocity,thruster"));
  Outcome outcome =
      testing::succeeded(run("inspect raw.csv --template vehicle.toml --json raw.json"));
  EXPECT_NE(outcome.out.find("belong together"), std::string::npos) << outcome.out;
  const auto json = parsed("raw.json");
  EXPECT_EQ(json["draft"]["complete"], true);
  EXPECT_GT(json["first_look"]["axes"][0]["r2"], 0.9);
  outcome = testing::succeeded(run("learn raw.csv --config vehicle.toml --out given"));
  outcome = run("learn raw.csv --out guessed");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("u = surge_velocity"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("--template"), std::string::npos);
  EXPECT_EQ(axis("given")["r2"], axis("guessed")["r2"]);
  EXPECT_GT(axis("given")["r2"]["final"], 0.9);
  EXPECT_EQ(content("guessed/log.toml"), content("vehicle.toml"));
  EXPECT_FALSE(exists("given/log.toml"));
  outcome = testing::succeeded(run("predict raw.csv --model guessed/model.json --out p.csv"));
  EXPECT_NE(outcome.out.find("udot: R² 0.9"), std::string::npos) << outcome.out;
  outcome = run("compare raw.csv --out compared");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
}

// Velocities under kelpie's names, so that the columns alone are all that a model wants.
TEST_F(DraftCommand, TheNextCommandsReadTheLogAsItWasLearned) {
  write("raw.csv", raw_log("t,u,thruster"));
  const Outcome learned = testing::succeeded(run("learn raw.csv --out g" + testing::kFewSamples));
  for (const std::string name : {"rollout raw.csv", "predict LOG", "learn LOG"}) {
    const std::size_t at = learned.out.find("kelpie " + name);
    ASSERT_NE(at, std::string::npos) << learned.out;
    std::string next = learned.out.substr(at + 7, learned.out.find("   (", at) - at - 7);
    EXPECT_NE(next.find(" --config g/log.toml"), std::string::npos) << next;
    if (const std::size_t log = next.find("LOG"); log != std::string::npos) {
      next.replace(log, 3, "raw.csv");
    }
    const Outcome outcome = testing::succeeded(run(next + " --out next_" + name.substr(0, 5)));
    EXPECT_EQ(outcome.out.find("no configuration"), std::string::npos) << outcome.out;
  }
}

TEST_F(DraftCommand, TwoReadingsAreRefusedByNameAndNothingIsWritten) {
  write("raw.csv", raw_log("t,surge,u"));
  const Outcome outcome = run("learn raw.csv --out out");
  testing::expect_refused(outcome, "velocities: surge, or u: which of them?");
  EXPECT_NE(outcome.err.find("kelpie inspect raw.csv --template"), std::string::npos);
  EXPECT_FALSE(exists("out"));
}

TEST_F(DraftCommand, ATemplateThatIsNotCompleteSaysWhatIsOpen) {
  write("raw.csv", raw_log("t,surge,depth"));
  const Outcome outcome = run("inspect raw.csv --template vehicle.toml");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(content("vehicle.toml").find("# - no commands are known"), std::string::npos);
  testing::expect_refused(run("inspect raw.csv --template raw.csv"), "--template: would overwrite");
}

TEST_F(DraftCommand, ADriveOfArdusubIsLearnedFromEitherRecordingWithoutAConfiguration) {
  write("drive.tlog", testing::ArdusubDrive::tlog().text());
  write("drive.BIN", testing::ArdusubDrive::bin());
  for (const std::string name : {"drive.tlog", "drive.BIN"}) {
    const Outcome outcome = testing::succeeded(
        run("learn " + name + " --verbose --out " + name + ".out" + testing::kFewSamples));
    for (const char* const said :
         {"ArduSub's frame: vectored, 6 motors", "rows while the motors are armed: 100 s of 140 s",
          "messages while the motors were disarmed", "9 (lights 1)"}) {
      EXPECT_NE(outcome.out.find(said), std::string::npos) << name << said << outcome.out;
    }
    const auto model = parsed(name + ".out/model.json");
    EXPECT_EQ(model.at("inputs").size(), 14U) << name;
  }
}

TEST_F(DraftCommand, WrongChecksumsAreToldInOneLineAndRefusedByStrict) {
  testing::Tlog log = testing::ArdusubDrive::tlog();
  log.bytes()[log.offsets()[500] + 20] ^= std::byte{0x55};
  write("drive.tlog", log.text());
  const Outcome outcome = testing::succeeded(run("inspect drive.tlog --json drive.json"));
  EXPECT_NE(outcome.err.find("passed over: 1 message with a wrong checksum"), std::string::npos)
      << outcome.err;
  EXPECT_EQ(parsed("drive.json").at("passed_over").size(), 1U);
  testing::expect_refused(run("inspect drive.tlog --strict"), "the checksum of message");
  EXPECT_EQ(run("inspect drive.tlog --strict --recover").exit_code, 2);
}

TEST_F(DraftCommand, RealLogsAreLearnedInOneCommand) {
  struct Case {
    std::string name, said;
  };
  for (const auto& [name, said] :
       {Case{"ros1_usv_sim.bag", "u = y_speed:data"},
        Case{"ardusub_small.tlog", "commands come at 2 Hz"}}) {  // armed for 16 s
    const std::filesystem::path log = testing::data_file("logs/" + name);
    if (log.empty()) {
      GTEST_SKIP() << name << " is in neither $KELPIE_DATA_DIR nor ../shared/data";
    }
    const Outcome outcome = run("learn " + log.string() + " --out out_" + name);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find(said), std::string::npos) << outcome.out;
  }
}

// 20 s at 50 Hz.
TEST_F(DraftCommand, NoChangeIsBelievedWhereAllTogetherForetellTheVehicle) {
  const std::filesystem::path log = testing::data_file("logs/ros1_usv_sim.bag");
  if (log.empty()) {
    GTEST_SKIP() << "the log is in neither $KELPIE_DATA_DIR nor ../shared/data";
  }
  testing::succeeded(run("learn " + log.string() + " --out out"));
  const nlohmann::json axis = parsed("out/result.json").at("axes").at(0);
  EXPECT_TRUE(axis.at("changes").empty());
  EXPECT_GT(axis.at("r2").at("final").get<double>(), 0.99);
}

}  // namespace
}  // namespace kelpie::draft_command_test
