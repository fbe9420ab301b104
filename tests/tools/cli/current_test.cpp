// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "alignment/drifting_log.hpp"
#include "cli/command.hpp"
#include "core/text.hpp"

namespace kelpie::cli_current_test {
namespace {

using testing::Outcome;

using Log = testing::DriftingLog;

std::string text_of(const Log& log, const std::string& heading) {
  std::string text = "t,u,v,r,n,m," + heading + ",udot,vdot,rdot\n";
  for (const std::size_t row : log.rows) {
    text += std::to_string(log.times[row]);
    for (std::size_t i = 0; i < 5; ++i) {
      text += "," + std::to_string(log.inputs[5 * row + i]);
    }
    text += "," + std::to_string(log.headings[row]);
    for (std::size_t i = 0; i < 3; ++i) {
      text += "," + std::to_string(log.targets[3 * row + i]);
    }
    text += "\n";
  }
  return text;
}

class CurrentOfALog : public testing::CommandTest {
 protected:
  void SetUp() override { write("log.csv", text_of(Log(Log::wandering, 1800), "psi")); }

  Outcome learn(const std::string& options, const std::string& out) {
    return testing::succeeded(run("learn log.csv --split blocks " + options + " --out " + out));
  }

  nlohmann::json json(const std::string& file) { return nlohmann::json::parse(content(file)); }

  double r2(const std::string& out, std::size_t axis) {
    return json(out + "/result.json")["axes"][axis]["r2"]["final"];
  }
};

TEST_F(CurrentOfALog, IsFoundToldAndTakenOffWhereverTheModelGoes) {
  const Outcome outcome = learn("--verbose", "out");
  EXPECT_NE(outcome.out.find("velocities are through the water: a current of"), std::string::npos)
      << outcome.out;
  const nlohmann::json current = json("out/model.json")["alignment"]["current"];
  EXPECT_EQ(current["heading"], "psi");
  EXPECT_EQ(json("out/model.json")["inputs"], nlohmann::json({"u", "v", "r", "n", "m"}));
  EXPECT_GT(json("out/result.json")["current"]["gain"], 0.2);
  EXPECT_NE(content("out/report.html").find("a current of"), std::string::npos);
  learn("--current none", "ground");
  EXPECT_TRUE(json("ground/model.json")["alignment"].is_null() ||
              json("ground/model.json")["alignment"]["current"].is_null());
  EXPECT_GT(r2("out", 0), r2("ground", 0) + 0.02);
  // A heading among the inputs leaves them with the current.
  learn("--inputs u,v,r,n,m,psi --targets udot,vdot,rdot", "named");
  EXPECT_EQ(json("named/model.json")["inputs"], json("out/model.json")["inputs"]);
  EXPECT_EQ(r2("named", 0), r2("out", 0));

  // Predictions are over ground, and rows are those of the log.
  const Outcome predicted = testing::succeeded(run("predict log.csv --model out/model.json"));
  EXPECT_NE(predicted.out.find("rows held out when it learned"), std::string::npos)
      << predicted.out;
  testing::succeeded(run("rollout log.csv --model out/model.json --horizons 1,5"));
  const Outcome exported = testing::succeeded(run("export out/model.json --c model.c"));
  EXPECT_NE(content("model.c").find("through the water"), std::string::npos);
}

TEST_F(CurrentOfALog, OfAnotherLogHasToBeGiven) {
  learn("", "out");
  write("other.csv", text_of(Log(Log::constant, 600), "psi"));
  testing::expect_refused(run("predict other.csv --model out/model.json"), "--current");
  testing::expect_refused(run("rollout other.csv --model out/model.json"), "--current");
  testing::expect_refused(run("predict other.csv --model out/model.json --current 1,x"),
                          "two speeds");
  const auto surge = [&](const std::string& wish) {
    const Outcome said =
        testing::succeeded(run("predict other.csv --model out/model.json --current " + wish));
    const std::size_t at = said.out.find("udot: R² ");
    return std::stod(said.out.substr(at + std::string("udot: R² ").size()));
  };
  EXPECT_GT(surge("0.25,-0.15"), 0.95);
  EXPECT_GT(surge("0.25,-0.15"), surge("none") + 0.1);
  write("silent.csv", text_of(Log(Log::constant, 600), "other"));
  testing::expect_refused(run("predict silent.csv --model out/model.json --current 0.25,-0.15"),
                          "psi");
}

TEST_F(CurrentOfALog, GoesWithoutAnAlignmentOfCommands) {
  learn("--align none", "out");
  EXPECT_FALSE(json("out/model.json")["alignment"]["current"].is_null());
  testing::succeeded(run("predict log.csv --model out/model.json"));
}

TEST_F(CurrentOfALog, StillWaterIsLearnedAsBefore) {
  write("log.csv", text_of(Log(Log::still, 1800), "psi"));
  learn("", "found");
  learn("--current none", "none");
  EXPECT_TRUE(json("found/result.json")["current"]["current"].is_null());
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(r2("found", axis), r2("none", axis));
  }
}

}  // namespace
}  // namespace kelpie::cli_current_test
