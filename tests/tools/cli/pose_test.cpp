// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "cli/command.hpp"
#include "log/pose_log.hpp"

namespace kelpie::cli_pose_test {
namespace {

using testing::Outcome;

class Poses : public testing::CommandTest {
 protected:
  void SetUp() override { write("log.csv", testing::PoseLog(450.0).csv(0.01)); }

  nlohmann::json json(const std::string& file) { return nlohmann::json::parse(content(file)); }
};

TEST_F(Poses, AreLearnedWithoutAVelocityInTheLog) {
  const Outcome outcome = testing::succeeded(run(
      "learn log.csv --pose x,y,psi --inputs u,v,r,n,m --rate 5 --out out" + testing::kFewSamples));
  EXPECT_NE(outcome.out.find("poses: velocities and accelerations over windows of"),
            std::string::npos)
      << outcome.out;
  const nlohmann::json result = json("out/result.json");
  EXPECT_EQ(json("out/model.json")["inputs"], nlohmann::json({"u", "v", "r", "n", "m"}));
  for (const auto& axis : result["axes"]) {
    EXPECT_GT(axis["r2"]["final"].get<double>(), 0.85) << axis["name"];
    EXPECT_NEAR(axis["intervals"]["held"].get<double>(), 0.9, 0.06) << axis["name"];
  }
  testing::succeeded(run("rollout log.csv --pose x,y,psi --rate 5 --model out/model.json"));
  testing::succeeded(
      run("predict log.csv --model out/model.json --pose x,y,psi --rate 5 --out p.csv"));

  // A configuration gives the same rows.
  write("c.toml",
        "[log]\ntime = \"t\"\nrate = 5\nwindow = \"auto\"\npose = {x = \"x\", y = \"y\", yaw = "
        "\"psi\"}\n[log.commands]\nn = \"n\"\nm = \"m\"\n");
  testing::succeeded(run("convert log.csv --config c.toml --out a.csv"));
  testing::succeeded(run("learn log.csv --config c.toml --out one" + testing::kFewSamples));
  EXPECT_EQ(json("one/model.json")["axes"], json("out/model.json")["axes"]);
  EXPECT_NE(content("a.csv").find("udot"), std::string::npos);
}

TEST_F(Poses, RowsAreHeldOutByAColumnOfTheLog) {
  const std::string log = testing::PoseLog(450.0).csv(0.01);
  std::istringstream lines(log);
  std::string line;
  std::getline(lines, line);
  std::string marked = line + ",held\n";
  while (std::getline(lines, line)) {
    const double t_s = std::stod(line);
    marked += line + (t_s > 200.0 && t_s < 300.0 ? ",1\n" : ",0\n");
  }
  write("marked.csv", marked);
  testing::succeeded(run(
      "learn marked.csv --pose x,y,psi --inputs u,v,r,n,m --rate 5 --split column:held --out out" +
      testing::kFewSamples));
  const nlohmann::json result = json("out/result.json");
  const double held_out_s = result["held_out_rows"].get<double>() / 5.0;
  EXPECT_LT(held_out_s, 100.0);
  EXPECT_GT(held_out_s, 80.0);  // but for rows whose window has rows of both sides
  EXPECT_EQ(json("out/model.json")["inputs"], nlohmann::json({"u", "v", "r", "n", "m"}));
}

TEST_F(Poses, AreRefusedWithWhatWouldBeRight) {
  testing::expect_refused(run("learn log.csv --pose x,psi --inputs u,v,r,n,m --out no"),
                          "x and y belong together");
  testing::expect_refused(run("learn log.csv --pose x,y --inputs u,v,r,n,m --out no"), "yaw");
  testing::expect_refused(run("learn log.csv --pose x,y,t --out no"), "names no part of a pose");
  testing::expect_refused(run("learn log.csv --pose x,y,heading --out no"), "heading");
}

}  // namespace
}  // namespace kelpie::cli_pose_test
