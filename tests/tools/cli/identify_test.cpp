// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "cli/command.hpp"

namespace kelpie::identify_test {
namespace {

using testing::kelpie;
using testing::Outcome;

const std::string kDagon = KELPIE_SOURCE_DIR "/vehicles/dagon.toml";

std::string scenario(const std::string& vehicle, const std::string& noise) {
  return "vehicle = \"" + vehicle + "\"\nrate_hz = 4.0\nnoise = \"" + noise +
         "\"\n[[configurations]]\nname = \"nominal\"\n[[phases]]\nconfiguration = \"nominal\"\n"
         "duration_s = 600.0\n";
}

std::vector<std::vector<double>> rows_of(const std::string& csv) {
  std::vector<std::vector<double>> rows;
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) {
      rows.back().push_back(std::stod(cell));
    }
  }
  return rows;
}

class Identify : public testing::CommandTest {
 protected:
  void simulate(const std::string& vehicle, const std::string& noise,
                const std::string& log) const {
    write("scenario.toml", scenario(vehicle, noise));
    const Outcome outcome = run("simulate scenario.toml --out " + log);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }

  void expect_refused(const std::string& arguments, const std::string& message) const {
    testing::expect_refused(run("identify " + arguments + " --out refused"), message);
    EXPECT_FALSE(exists("refused")) << arguments;
  }
};

// Simulate, identify, simulate again: the identified vehicle drives as the true one does.
TEST_F(Identify, TheIdentifiedVehicleDrivesAsTheTrueOne) {
  simulate(kDagon, "as_recorded", "log.csv");
  const Outcome outcome = testing::succeeded(kelpie(
      folder_.path(), "identify log.csv --thrust th1=0.0262 --vehicle " + kDagon + " --out out"));
  simulate(kDagon, "none", "true.csv");
  simulate("out/vehicle.toml", "none", "again.csv");
  const auto truth = rows_of(content("true.csv"));
  const auto again = rows_of(content("again.csv"));
  ASSERT_EQ(truth.size(), again.size());
  for (std::size_t column = 2; column < 5; ++column) {  // u, v, r
    double off = 0.0;
    double all = 0.0;
    for (std::size_t row = 0; row < truth.size(); ++row) {
      off += std::pow(again[row][column] - truth[row][column], 2.0);
      all += std::pow(truth[row][column], 2.0);
    }
    EXPECT_LT(std::sqrt(off / all), 0.02) << column;
  }
  for (const char* const file :
       {"parameters.yaml", "identify.html", "gazebo.sdf", "uuv_simulator.xacro", "stonefish.xml"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / file)) << file;
  }
  const std::string gazebo = content("out/gazebo.sdf");
  EXPECT_NE(gazebo.find("<xU>-1"), std::string::npos) << gazebo;  // SNAME: drag is negative
  EXPECT_NE(gazebo.find("<fluid_added_mass>"), std::string::npos);
  EXPECT_NE(content("out/uuv_simulator.xacro").find("<linear_damping>\n          -1"),
            std::string::npos);
}

TEST_F(Identify, WithoutAScaleThereAreRatiosAndNoFilesOfSimulators) {
  simulate(kDagon, "as_recorded", "log.csv");
  const Outcome outcome = testing::succeeded(run("identify log.csv --out out"));
  EXPECT_NE(outcome.out.find("Ratios only"), std::string::npos) << outcome.out;
  EXPECT_NE(content("out/parameters.yaml").find("\"sway_inertia\": {unit: \"1\""),
            std::string::npos);
  EXPECT_FALSE(exists("out/vehicle.toml"));
  EXPECT_FALSE(exists("out/gazebo.sdf"));

  expect_refused("log.csv --targets udot,vdot", "velocity of surge");
  expect_refused("log.csv --inputs u,v,r,th1,th2,t", "has no name of a thruster's speed");
  expect_refused("log.csv --inputs u,v,r,th1 --thrusters th4", "did you mean 'th1'?");
  expect_refused("log.csv --inputs u,v,r", "nothing drives the vehicle");
  expect_refused("log.csv --thrust th9=1", "there is no thruster 'th9'");
  expect_refused("log.csv --thrust th1=some", "is no number");
  expect_refused("log.csv --surge-added-mass 3", "needs --mass");
  expect_refused("log.csv --mass -3", "has to be > 0");
  expect_refused("log.csv --frame ned", "is no frame");
  expect_refused("log.csv --only 7", "log.csv has no configuration 7");
  write("bad.toml", "[body]\n");
  expect_refused("log.csv --vehicle bad.toml", "mass_kg");
  expect_refused("log.csv --inputs u,v,r,th1,th2 --targets udot,vdot,th3",
                 "th3: isn't the acceleration of 'r'");
}

}  // namespace
}  // namespace kelpie::identify_test
