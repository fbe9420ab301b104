// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "cli/command.hpp"

namespace kelpie::rollout_test {
namespace {

using testing::Outcome;

class RolloutCommand : public testing::CommandTest {
 protected:
  void SetUp() override { learn_little_log(3000); }

  Outcome rollout(const std::string& arguments) {
    return run("rollout --model out/model.json --out roll " + arguments);
  }
};

TEST_F(RolloutCommand, JudgesAModelOnHeldOutRows) {
  const Outcome outcome = testing::succeeded(rollout("log.csv --horizons 5,1 --units u=m/s"));
  EXPECT_TRUE(std::regex_search(
      outcome.out, std::regex("\nAfter 5 s: u within 0\\.00[0-4][0-9]? m/s \\(root mean square")))
      << outcome.out;
  EXPECT_NE(outcome.out.find("next:    kelpie export out/model.json --c model.c\n"),
            std::string::npos);
  EXPECT_EQ(outcome.out.find("recursive least squares"), std::string::npos) << outcome.out;
  EXPECT_NE(rollout("log.csv --horizons 5,1 --verbose").out.find("recursive least squares"),
            std::string::npos);
  EXPECT_EQ(rollout("log.csv --horizons 5,1 --json").out, content("roll/result.json"));
  const auto json = parsed("roll/result.json");
  EXPECT_EQ(json["states"], nlohmann::json::array({"u"}));
  EXPECT_EQ(json["scores"][0]["horizons"][0]["seconds"], 1.0);
  EXPECT_GT(json["scores"][0]["horizons"][1]["r2"][0], 0.99);
  EXPECT_TRUE(json["scores"][0]["dead_reckoning"].empty());  // no sway, no yaw
  EXPECT_EQ(content("roll/example.csv").substr(0, 33), "t_s,u,u_spread,u_measured,beyond\n");
  EXPECT_TRUE(exists("roll/report.html"));
}

TEST_F(RolloutCommand, KeepsTheUnitsOfTheModel) {
  testing::succeeded(
      run("learn log.csv --units u=m/s,udot=m/s^2 --out out" + testing::kFewSamples));
  testing::succeeded(rollout("log.csv --horizons 1,10"));
  EXPECT_NE(content("roll/report.html").find("After 10 s surge is within"), std::string::npos);
  EXPECT_NE(content("roll/report.html").find("u<br/>in m/s"), std::string::npos);
}

TEST_F(RolloutCommand, FollowsCommandsFromAStart) {
  std::string commands = "t,n\n";
  for (int i = 0; i <= 400; ++i) {
    commands += std::to_string(0.1 * i) + ",5\n";
  }
  write("commands.csv", commands);
  const Outcome outcome = testing::succeeded(rollout("commands.csv --start u=0.1 --commands held"));
  const std::string path = content("roll/rollout.csv");
  EXPECT_EQ(path.substr(0, 28), "t_s,u,u_spread,beyond\n0,0.1,");
  // At rest 0.01 · 25 = 2 u² + 0.3 u.
  const std::string last = path.substr(path.rfind('\n', path.size() - 2) + 1);
  EXPECT_NEAR(std::stod(last.substr(last.find(',') + 1)), 0.2865, 0.01) << last;
  testing::succeeded(run("learn log.csv --units n=rev/s --out out" + testing::kFewSamples));
  EXPECT_NE(rollout("commands.csv --start u=0.1 --units n=V").err.find("the model learned rev/s"),
            std::string::npos);
}

TEST_F(RolloutCommand, RefusesWithExitCodeTwo) {
  write("other.csv", "t,u,m,udot\n0,1,2,3\n");
  const std::vector<std::pair<std::string, std::string>> cases{
      {"log.csv --start w=1",
       "--start: 'w' is no velocity of the model (did you mean 'u'?); there are u"},
      {"log.csv --start u=fast", "--start u: 'fast' is not a finite number"},
      {"absent.csv", "absent.csv"},
      {"other.csv", "; a column of the model in out/model.json"},
      {"log.csv --inputs nonsense", "--inputs: are those of the model: u,n"},
      {"log.csv --targets x,y", "--targets: are those of the model: udot"},
      {"log.csv --start u=0 --json", "--json: belongs to the judgement of a log"},
      {"log.csv --start u=0 --verbose", "--verbose: belongs to the judgement of a log"},
      {"log.csv --start u=0 --horizons 5", "--horizons: belongs to the judgement of a log"},
      {"log.csv --start u=0 --split tail", "--split: belongs to the judgement of a log"},
      {"log.csv --start u=0 --seed 3", "--seed: belongs to the judgement of a log"},
      {"log.csv --start u=0 --current none", "--current: belongs to the judgement of a log"},
  };
  for (const auto& [arguments, words] : cases) {
    testing::expect_refused(rollout(arguments), words);
  }
  EXPECT_FALSE(exists("roll"));
}

TEST_F(RolloutCommand, TellsWhyAModelCannotBeRolledOut) {
  const auto expect = [&](const std::string& model, const std::string& reason) {
    testing::expect_refused(run("rollout log.csv --out roll --model " + model),
                            "udot: cannot be rolled out: " + reason);
  };
  testing::succeeded(run("learn log.csv --out none --set states=none" + testing::kFewSamples));
  expect("none/model.json",
         "the model doesn't know which input is its velocity (setting 'states')");
  nlohmann::json model = parsed("out/model.json");
  nlohmann::json& steady = model["axes"][0]["steady"];
  const std::string too_little = "the model learned too little so far, or in an earlier version of";
  nlohmann::json of_other_terms = steady;
  of_other_terms.erase("share");
  std::swap(steady, of_other_terms);
  write("older.json", model.dump());
  expect("older.json", too_little);
  model["axes"][0].erase("steady");
  write("oldest.json", model.dump());
  expect("oldest.json", too_little);
  model["axes"][0]["steady"] = nullptr;
  write("young.json", model.dump());
  expect("young.json", too_little);
  EXPECT_FALSE(exists("roll"));
}

}  // namespace
}  // namespace kelpie::rollout_test
