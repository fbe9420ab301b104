// SPDX-License-Identifier: Apache-2.0
// The countdown of parameters while the vehicle drives.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "console/live_command.hpp"

namespace kelpie::live_parameters_test {
namespace {

using testing::Listener;
using testing::LiveCommand;
using testing::Outcome;
using testing::succeeded;

class LiveParameters : public LiveCommand {
 protected:
  // Five minutes of the simulated vehicle; the last row is one of those at which is identified.
  void simulate() const {
    write("scenario.toml", "vehicle = \"" KELPIE_SOURCE_DIR
                           "/vehicles/dagon.toml\"\nrate_hz = 4.0\nnoise = \"as_recorded\"\n"
                           "[[configurations]]\nname = \"nominal\"\n[[phases]]\n"
                           "configuration = \"nominal\"\nduration_s = 300.25\n");
    succeeded(run("simulate scenario.toml --out dive.csv"));
  }
};

TEST_F(LiveParameters, AreThoseOfIdentifyOnTheSameRows) {
  simulate();
  const Listener listener;
  const Outcome outcome =
      succeeded(run("live --replay dive.csv --speed max --out out --tell all --thrust th1=0.0262 "
                    "--percent 20 --plotjuggler " +
                    listener.port()));
  EXPECT_NE(outcome.err.find(" parameters known to ± 20 %; least known: "), std::string::npos)
      << outcome.err;
  nlohmann::json told;
  for (const nlohmann::json& message : listener.heard()) {
    if (message["kelpie"].contains("parameter")) {
      told = message["kelpie"]["parameter"];
    }
  }
  const nlohmann::json identified = nlohmann::json::parse(
      succeeded(run("identify dive.csv --split none --thrust th1=0.0262 --json --out of_identify"))
          .out);
  std::size_t checked = 0;
  for (const nlohmann::json& parameter : identified["parameters"]) {
    const std::string name = parameter["name"];
    if (told.contains(name) && parameter["state"] == "identified") {
      ++checked;
      EXPECT_DOUBLE_EQ(told[name]["parameter_value"], parameter["value"]) << name;
    }
  }
  EXPECT_GT(checked, 12U);
}

TEST_F(LiveParameters, ANameThatIsNoneIsRefusedBeforeTheVehicleDrives) {
  simulate();
  const std::string replay = "--replay dive.csv --speed max --out out ";
  expect_refused(replay + "--tell sway_drug", "'sway_drug' is no parameter");
  expect_refused(replay + "--tell th1 --thrust th9=0.1", "'th9' is no thruster");
  expect_refused(replay + "--thrust th1=0.1", "--tell");
  write("x.toml", "[live.parameters]\npercent = 0\n");
  expect_refused(replay + "--config x.toml", "x.toml:2");
  EXPECT_FALSE(exists("out"));
}

}  // namespace
}  // namespace kelpie::live_parameters_test
