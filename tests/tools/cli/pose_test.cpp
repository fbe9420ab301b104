// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "core/angle.hpp"
#include "kelpie/core/random.hpp"
#include "log/dataset.hpp"
#include "log/pose_log.hpp"

namespace kelpie::cli_pose_test {
namespace {

using testing::Outcome;

class Poses : public testing::CommandTest {
 protected:
  void SetUp() override { write("log.csv", testing::PoseLog(330.0).csv(0.01)); }

  nlohmann::json json(const std::string& file) { return parsed(file); }
};

TEST_F(Poses, AreLearnedWithoutAVelocityInTheLog) {
  write("log.csv", testing::PoseLog(450.0).csv(0.01));
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

// Units go by the names of the log's columns, as --pose does.
TEST_F(Poses, AnglesInDegreesAreConverted) {
  log::Table table = log::read_csv(folder_ / "log.csv");
  for (double& angle : table.columns[table.find("psi")]) {
    angle *= 180.0 / std::numbers::pi;
  }
  log::write_csv(folder_ / "degrees.csv", table);
  const std::string rest = " --inputs u,v,r,n,m --rate 5 --align none" + testing::kFewSamples;
  testing::succeeded(run("learn log.csv --pose x,y,psi --out rad" + rest));
  const double r2 = json("rad/result.json")["axes"][2]["r2"]["final"];
  for (const std::string pose : {"x,y,psi", "x=x,y=y,yaw=psi"}) {
    testing::succeeded(
        run("learn degrees.csv --pose " + pose + " --units psi=deg --out degrees" + rest));
    EXPECT_NEAR(json("degrees/result.json")["axes"][2]["r2"]["final"].get<double>(), r2, 0.01);
  }
}

// The simulated Dagon's log as poses at 5 Hz: velocities are integrated by the trapezoidal rule,
// and noise is added. No velocity is left.
std::string poses_of(const log::Table& simulated, double noise_m) {
  const auto column = [&](const char* name) -> const std::vector<double>& {
    return simulated.columns[simulated.find(name)];
  };
  RandomStream random(3, "poses");
  std::string csv = "t,x,y,psi,th1,th2,th3\n";
  std::array<double, 3> pose{};
  std::array<double, 3> last{};  // velocities in the world
  for (std::size_t row = 0; row < simulated.rows(); ++row) {
    const double half_s = row == 0 ? 0.0 : 0.5 * (column("t")[row] - column("t")[row - 1]);
    const double u = column("u")[row];
    const double v = column("v")[row];
    const double r = column("r")[row];
    pose[2] += half_s * (last[2] + r);
    const std::array<double, 3> now{u * std::cos(pose[2]) - v * std::sin(pose[2]),
                                    u * std::sin(pose[2]) + v * std::cos(pose[2]), r};
    pose[0] += half_s * (last[0] + now[0]);
    pose[1] += half_s * (last[1] + now[1]);
    last = now;
    if (row % 5 == 0) {
      csv += fmt::format("{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", column("t")[row],
                         pose[0] + noise_m * random.normal(), pose[1] + noise_m * random.normal(),
                         wrapped(pose[2] + 0.0035 * random.normal()), column("th1")[row],
                         column("th2")[row], column("th3")[row]);
    }
  }
  return csv;
}

TEST_F(Poses, RowsAreHeldOutByAColumnOfTheLog) {
  std::istringstream lines(content("log.csv"));
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

TEST_F(Poses, TellTheVehiclesParametersWithoutAVelocity) {
  write("s.toml", "vehicle = \"" KELPIE_SOURCE_DIR
                  "/vehicles/dagon.toml\"\nrate_hz = 25.0\nnoise = \"none\"\n"
                  "[[configurations]]\nname = \"nominal\"\n[[phases]]\nconfiguration = "
                  "\"nominal\"\nduration_s = 900.0\n");
  testing::succeeded(run("simulate s.toml --out simulated.csv"));
  write("poses.csv", poses_of(log::read_csv(folder_ / "simulated.csv"), 0.1));
  const Outcome outcome =
      testing::succeeded(run("identify poses.csv --pose x,y,psi --thrust th1=0.0262 --split none "
                             "--json --out identified"));
  std::map<std::string, double> value;
  const nlohmann::json found = nlohmann::json::parse(outcome.out);
  for (const auto& one : found["parameters"]) {
    ASSERT_TRUE(one["value"].is_number()) << one;
    value[one["name"]] = one["value"];
  }
  EXPECT_NEAR(value["th1.reverse"], 0.0200, 0.001);
  EXPECT_NEAR(value["th2.forward"], 0.0262, 0.001);
  EXPECT_NEAR(value["th3.forward"], 0.0364, 0.0015);
  const auto drag = [&](const std::string& axis, double speed) {
    return value[axis + "_linear_drag"] + speed * value[axis + "_quadratic_drag"];
  };
  EXPECT_NEAR(drag("surge", 0.09), 14.45, 0.05 * 14.45);
  EXPECT_NEAR(drag("sway", 0.07), 19.13, 0.05 * 19.13);
  EXPECT_NEAR(drag("yaw", 0.35), 1.65, 0.15 * 1.65);
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
