// SPDX-License-Identifier: Apache-2.0
// What a newcomer does in a first hour, and what must not go wrong there.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "support.hpp"

namespace kelpie::first_hour_test {
namespace {

namespace fs = std::filesystem;
using testing::Outcome;
using testing::succeeded;

class FirstHour : public testing::CommandTest {
 protected:
  // A drive of the simulated vehicle: t,conf,u,v,r,th1,th2,th3,udot,vdot,rdot, …
  void simulate(const std::string& scenario, const std::string& log) const {
    succeeded(run("simulate " KELPIE_SOURCE_DIR "/scenarios/" + scenario + " --out " + log));
  }
  // The log again, every cell after `change(column, cell)`.
  template <typename Change>
  void rewrite(const std::string& from, const std::string& to, const Change& change) const {
    std::istringstream lines(content(from));
    std::string line;
    std::getline(lines, line);
    const std::vector<std::string> names = cells_of(line);
    std::string text = line + "\n";
    while (std::getline(lines, line)) {
      const std::vector<std::string> cells = cells_of(line);
      for (std::size_t i = 0; i < cells.size(); ++i) {
        text += (i == 0 ? "" : ",") + change(names[i], cells[i]);
      }
      text += "\n";
    }
    write(to, text);
  }
  static std::vector<std::string> cells_of(const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream all(line);
    for (std::string cell; std::getline(all, cell, ',');) {
      cells.push_back(cell);
    }
    return cells;
  }
  std::vector<double> r2_of(const std::string& folder) const {
    std::vector<double> values;
    const nlohmann::json result = parsed(folder + "/result.json");
    for (const nlohmann::json& axis : result["axes"]) {
      values.push_back(axis["r2"]["final"]);
    }
    return values;
  }
};

bool is_thruster(const std::string& column) {
  return column.starts_with("th");
}

// D1: of a log whose commands are pulses the same is learned as of rotor speeds.
TEST_F(FirstHour, PulsesAreLearnedAsTheSpeedsTheyStandFor) {
  simulate("small.toml", "speeds.csv");
  rewrite("speeds.csv", "pulses.csv", [](const std::string& column, const std::string& cell) {
    return is_thruster(column)
               ? std::to_string(static_cast<int>(std::lround(1500.0 + 32.0 * std::stod(cell))))
               : cell;
  });
  succeeded(run("learn speeds.csv --out speeds" + testing::kFewSamples));
  const Outcome outcome = succeeded(run("learn pulses.csv --out pulses" + testing::kFewSamples));
  EXPECT_NE(outcome.out.find("rest at 1500"), std::string::npos) << outcome.out;
  const std::vector<double> speeds = r2_of("speeds");
  const std::vector<double> pulses = r2_of("pulses");
  ASSERT_EQ(speeds.size(), 3U);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(pulses[axis], speeds[axis], 0.01) << axis;
  }
}

// D3: velocities are known wherever they stand, and columns that are no inputs do no harm.
TEST_F(FirstHour, TheOrderOfColumnsAndColumnsBesideChangeNothing) {
  simulate("small.toml", "log.csv");
  std::istringstream lines(content("log.csv"));
  std::string text;
  int row = -1;
  for (std::string line; std::getline(lines, line); ++row) {
    const std::vector<std::string> cell = cells_of(line);
    const std::string more =
        row < 0 ? "depth,run,heading,battery_v,lat"
                : std::to_string(0.1 * (row % 70)) + "," + std::to_string(row / 500) + "," +
                      std::to_string(0.01 * (row % 600)) + "," + std::to_string(16.0 - 1e-4 * row) +
                      "," + std::to_string(53.0 + 1e-6 * row);
    text += more;
    for (const std::size_t column : {5U, 6U, 7U, 2U, 3U, 4U, 0U, 8U, 9U, 10U}) {
      text += "," + cell[column];
    }
    text += "\n";
  }
  write("other.csv", text);
  succeeded(run("learn log.csv --out log" + testing::kFewSamples));
  const Outcome outcome = succeeded(run("learn other.csv --out other" + testing::kFewSamples));
  EXPECT_NE(outcome.out.find("velocities: u, v, r\ncommands: th1, th2, th3"), std::string::npos)
      << outcome.out;
  EXPECT_EQ(r2_of("other"), r2_of("log"));
  EXPECT_NE(outcome.err.find("depth: is left out of the inputs: a position"), std::string::npos);
}

// D5: no model is no success, and one sentence says so.
TEST_F(FirstHour, ALogTooShortForAModelEndsWithCodeTwo) {
  write("short.csv", testing::little_log(9));
  const Outcome outcome = run("learn short.csv --out out");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("nothing was learned: 8 training rows are too few for a model"),
            std::string::npos)
      << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_FALSE(exists("out/model.json"));
  EXPECT_NE(content("out/report.html").find("Nothing was learned"), std::string::npos);
}

// D7, D11: the finding, the thrusters' health and the page say the same, long after the damage.
void expect_one_finding(const Outcome& outcome, const std::string& page) {
  EXPECT_NE(outcome.out.find("since 1500.5 s: th2 gives 60.0 % of its thrust"), std::string::npos)
      << outcome.out;
  const std::size_t table = outcome.out.find("Thrusters");
  ASSERT_NE(table, std::string::npos) << outcome.out;
  const std::size_t th2 = outcome.out.find("th2 ", table);
  ASSERT_NE(th2, std::string::npos);
  EXPECT_NE(outcome.out.substr(th2, 20).find("60 %"), std::string::npos)
      << outcome.out.substr(table);
  // The vehicle changed at 1500.25 s, in a held-out block: marks stand there, not rows before.
  EXPECT_NE(page.find("1500.25"), std::string::npos);
}

// D8: the next command learns the changed vehicle alone, and surge is as good as before.
TEST_F(FirstHour, TheChangeIsToldAlikeAndTheChangedVehicleLearnedAlone) {
  simulate("diagnosis.toml", "log.csv");
  const Outcome outcome = succeeded(run("learn log.csv --out out --verbose"));
  expect_one_finding(outcome, content("out/report.html"));
  EXPECT_NE(outcome.out.find("kelpie learn log.csv --since 1500.5 --out out/since"),
            std::string::npos)
      << outcome.out;
  const Outcome since = succeeded(run("learn log.csv --since 1500.5 --out since"));
  EXPECT_NE(since.out.find("no change of the vehicle was found"), std::string::npos) << since.out;
  for (const double r2 : r2_of("since")) {
    EXPECT_GT(r2, 0.98);
  }
  const Outcome late = run("learn log.csv --since 5000 --out late");
  EXPECT_EQ(late.exit_code, 2);
  EXPECT_NE(late.err.find("--since: 5000 s leaves too few rows; the log lasts from"),
            std::string::npos)
      << late.err;
  EXPECT_EQ(run("learn log.csv log.csv --since 5 --out late").exit_code, 2);
}

// A propeller that was blocked and runs again.
TEST_F(FirstHour, AThrusterThatComesBackHasItsThrust) {
  write("freed.toml", "vehicle = \"" KELPIE_SOURCE_DIR
                      "/vehicles/dagon.toml\"\n"
                      R"(
seed = 1
rate_hz = 4.0
noise = "as_recorded"
configurations = [{ name = "nominal" }, { name = "blocked", effectiveness = { surge_right = 0.0 } }]
phases = [{ configuration = "nominal", duration_s = 700.0 },
          { configuration = "blocked", duration_s = 300.0 },
          { configuration = "nominal", duration_s = 500.0 }]
)");
  succeeded(run("simulate freed.toml --out log.csv"));
  const Outcome outcome =
      succeeded(run("learn log.csv --out out --verbose" + testing::kFewSamples));
  const std::size_t row = outcome.out.find("th2 ", outcome.out.find("Thrusters in the last"));
  ASSERT_NE(row, std::string::npos) << outcome.out;
  std::istringstream cells(outcome.out.substr(row + 4));
  double share = 0.0;
  cells >> share;
  EXPECT_NEAR(share, 100.0, 10.0) << outcome.out.substr(row, 60);
  const nlohmann::json result = parsed("out/result.json");
  const nlohmann::json& cause = result["diagnosis"]["findings"].back()["causes"][0];
  EXPECT_NEAR(cause["size"], 1.0, 0.1);
  EXPECT_NEAR(cause["before"], 0.0, 0.02);
  EXPECT_NE(outcome.out.find(" % of its nominal thrust again ("), std::string::npos) << outcome.out;
}

// D9: identify tells nothing of pulses rather than NaN.
TEST_F(FirstHour, NothingThatIsIdentifiedIsNaN) {
  simulate("small.toml", "speeds.csv");
  rewrite("speeds.csv", "pulses.csv", [](const std::string& column, const std::string& cell) {
    return is_thruster(column)
               ? std::to_string(static_cast<int>(std::lround(1500.0 + 32.0 * std::stod(cell))))
               : cell;
  });
  const Outcome outcome = run("identify pulses.csv --out out");
  if (outcome.exit_code == 0) {
    EXPECT_EQ(content("out/parameters.yaml").find("nan"), std::string::npos);
  } else {
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_FALSE(outcome.err.empty());
  }
}

// D14: a model of other units is told, not scored alone.
TEST_F(FirstHour, PredictionsFarOutsideOfWhatWasSeenAreTold) {
  write("log.csv", testing::little_log(1500));
  rewrite("log.csv", "cm.csv", [](const std::string& column, const std::string& cell) {
    return column == "u" ? std::to_string(100.0 * std::stod(cell)) : cell;
  });
  succeeded(run("learn log.csv --quiet"));
  const Outcome same = succeeded(run("predict log.csv"));
  EXPECT_EQ(same.err.find("WARNING"), std::string::npos) << same.err;
  const Outcome other = succeeded(run("predict cm.csv"));
  EXPECT_NE(other.err.find("WARNING: u is far outside of what the model has seen"),
            std::string::npos)
      << other.err;
}

// One message says all that has to be given.
TEST_F(FirstHour, ABagOfUnknownTypesNamesTheOptionForThem) {
  const fs::path bag = testing::data_file("flatfish_bag");
  if (bag.empty()) {
    GTEST_SKIP() << "no data";
  }
  const Outcome outcome = run("learn '" + bag.string() + "' --out out");
  EXPECT_EQ(outcome.exit_code, 2);
  for (const char* const words :
       {"no commands are known by type or name", "/flatfish/thruster_surge_left/thruster_status",
        "thruster_enitech/ThrusterStatus", "--msg-dir"}) {
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
  }
  succeeded(run("learn '" + bag.string() +
                "' --msg-dir " KELPIE_SOURCE_DIR "/examples/msg --out out" + testing::kFewSamples));
}

// A draft that cannot be is no message about a file that nobody wrote.
TEST_F(FirstHour, ALogTooSlowForAccelerationsSaysSo) {
  std::string text = "time,w,pitch,pump\n";
  for (int i = 0; i < 300; ++i) {
    text += std::to_string(18 * i) + "," + std::to_string(std::sin(0.3 * i)) + "," +
            std::to_string(std::cos(0.2 * i)) + "," + std::to_string(i % 17) + "\n";
  }
  write("glider.csv", text);
  testing::expect_refused(run("learn glider.csv"), "velocities come every 18 s, too slowly");
}

}  // namespace
}  // namespace kelpie::first_hour_test
