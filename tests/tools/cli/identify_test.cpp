// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
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

double number_after(const std::string& text, const std::string& mark, std::size_t from) {
  const std::size_t at = text.find(mark, from);
  return at == std::string::npos ? std::nan("") : std::stod(text.substr(at + mark.size()));
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

// A log with three of four cells of its columns from the `first` to the `last` empty.
std::string with_every_fourth(const std::string& csv, std::size_t first, std::size_t last) {
  std::istringstream lines(csv);
  std::string text;
  std::string line;
  for (std::size_t row = 0; std::getline(lines, line); ++row) {
    std::istringstream cells(line);
    std::string cell;
    for (std::size_t column = 0; std::getline(cells, cell, ','); ++column) {
      const bool is_empty = row % 4 != 0 && column >= first && column <= last;
      text += std::string(column == 0 ? "" : ",") + (is_empty ? "" : cell);
    }
    text += '\n';
  }
  return text;
}

class Identify : public testing::CommandTest {
 protected:
  void simulate(const std::string& vehicle, const std::string& noise,
                const std::string& log) const {
    write("scenario.toml", scenario(vehicle, noise));
    const Outcome outcome = run("simulate scenario.toml --out '" + log + "'");
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
  const Outcome outcome = testing::succeeded(
      run("identify log.csv --thrust th1=0.0262 --vehicle " + kDagon + " --out out"));
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
       {"parameters.yaml", "identify.html", "certificate.json", "gazebo.sdf", "gazebo_plugin.sdf",
        "uuv_simulator.xacro", "stonefish.xml", "mss.m", "python_vehicle.py"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / file)) << file;
  }
  const std::string gazebo = content("out/gazebo.sdf");
  EXPECT_NE(gazebo.find("<xU>-1"), std::string::npos) << gazebo;  // SNAME: drag is negative
  EXPECT_NE(gazebo.find("<fluid_added_mass>"), std::string::npos);
  EXPECT_NE(content("out/uuv_simulator.xacro").find("<linear_damping>\n          -1"),
            std::string::npos);
}

const std::string kHeavy = KELPIE_SOURCE_DIR "/vehicles/bluerov2_heavy.toml";

// Five minutes of the vehicle by a free pilot, who takes new speeds every `period_s`.
std::string piloted_heavy(const std::string& period_s) {
  return "vehicle = \"" + kHeavy +
         "\"\nrate_hz = 20.0\nlog = \"six_axes\"\nnoise = \"as_recorded\"\n"
         "[excitation]\nmode = \"pilot\"\nperiod_s = [" +
         period_s +
         "]\neffort = [50, 50, 40, 6, 6, 4]\ndither = 0.1\n[[configurations]]\n"
         "name = \"nominal\"\n[[phases]]\nconfiguration = \"nominal\"\n"
         "duration_s = 300.0\n";
}

TEST_F(Identify, SixAxesWhereTheVehicleFileHasTheLogsThrusters) {
  write("heavy.toml", piloted_heavy("1.0, 6.0"));
  testing::succeeded(run("simulate heavy.toml --out heavy.csv"));
  const std::string known = "heavy.csv --vehicle " + kHeavy;
  const Outcome outcome = testing::succeeded(
      run("identify " + known +
          " --volts voltage --for kelpie,gazebo,gazebo_plugin --out out --verbose"));
  const std::string yaml = content("out/parameters.yaml");
  EXPECT_NE(yaml.find("on six axes"), std::string::npos) << yaml;
  EXPECT_NE(yaml.find("frame: FRD"), std::string::npos);
  EXPECT_NE(yaml.find("added mass in surge of the vehicle file, taken as exact"),
            std::string::npos);
  const std::size_t at = yaml.find("\"heave_inertia\"");
  ASSERT_NE(at, std::string::npos) << yaml;
  EXPECT_NEAR(number_after(yaml, "value: ", at), 13.5 + 18.68, 0.5);
  EXPECT_TRUE(exists("out/gazebo.sdf"));
  EXPECT_FALSE(exists("out/mss.m")) << "not asked for";
  const std::string certificate = content("out/certificate.json");
  EXPECT_NE(certificate.find("\"engine\": \"gazebo_plugin\""), std::string::npos) << certificate;
  EXPECT_NE(certificate.find("\"limited_by\": \"added mass\""), std::string::npos);
  EXPECT_EQ(certificate.find("stonefish"), std::string::npos);
  EXPECT_NE(outcome.out.find("gazebo_plugin (Gazebo, added mass by the Hydrodynamics plugin) is "
                             "unstable"),
            std::string::npos)
      << outcome.out;
  write("again.toml",
        std::string(content("heavy.toml"))
            .replace(0, content("heavy.toml").find('\n'), "vehicle = \"out/vehicle.toml\""));
  testing::succeeded(run("simulate again.toml --out again.csv"));
  expect_refused(known + " --for gazebbo", "did you mean 'gazebo'?");
  expect_refused(known + " --for orca4",
                 "gazebo, gazebo_plugin, uuv_simulator, stonefish, mss, python_vehicle_simulator");
  expect_refused(known + " --volts batt", "batt");
  write(
      "signals.toml",
      "[log]\nrate = 20\ntime = \"t\"\n[log.states]\nu = \"u\"\n[log.derived]\nudot = \"d(u)\"\n");
  expect_refused(known + " --config signals.toml --volts voltage",
                 "signals.toml: log.states: has no voltage, which an option names");
  std::string other = testing::content_of(kHeavy);
  other.replace(other.find("nominal_v = 16.0"), 16, "nominal_v = 1600.0");
  write("other.toml", other);
  expect_refused("heavy.csv --vehicle other.toml --volts voltage", "voltage is 1600 V");
}

// Lines between samples of 5 Hz cut the crests of velocities, so that masses and thrusts are wrong
// by several standard errors.
TEST_F(Identify, VelocitiesThatComeSlowerThanTheRowsAreNoLines) {
  write("heavy.toml", piloted_heavy("0.5, 2.0"));
  testing::succeeded(run("simulate heavy.toml --out heavy.csv"));
  write("slow.csv", with_every_fourth(content("heavy.csv"), 2, 4));
  write("signals.toml", R"toml([log]
rate = 20
time = "t"
window = 0.6
inputs = ["u", "v", "w", "p", "q", "r", "phi", "theta", "m1", "m2", "m3", "m4", "m5", "m6", "m7", "m8"]
targets = ["udot", "vdot", "wdot", "pdot", "qdot", "rdot"]
[log.states]
u = "u"
v = "v"
w = "w"
p = "p"
q = "q"
r = "r"
phi = "phi"
theta = "theta"
voltage = "voltage"
[log.commands]
m1 = "m1"
m2 = "m2"
m3 = "m3"
m4 = "m4"
m5 = "m5"
m6 = "m6"
m7 = "m7"
m8 = "m8"
[log.derived]
udot = "d(u)"
vdot = "d(v)"
wdot = "d(w)"
pdot = "d(p)"
qdot = "d(q)"
rdot = "d(r)"
)toml");
  testing::succeeded(run("identify slow.csv --config signals.toml --vehicle " + kHeavy +
                         " --volts voltage --for kelpie --out out"));
  const std::string yaml = content("out/parameters.yaml");
  int held = 0;
  for (int k = 1; k <= 8; ++k) {
    const std::size_t at = yaml.find("\"m" + std::to_string(k) + ".forward\"");
    const double low = number_after(yaml, "interval90: [", at);
    const double high = number_after(yaml, ", ", yaml.find("interval90", at));
    held += low <= 51.5 && 51.5 <= high ? 1 : 0;
  }
  EXPECT_GE(held, 7) << yaml;
}

// A log with a column in degrees in place of radians.
std::string in_degrees(const std::string& csv, const std::string& wanted) {
  const std::string head = csv.substr(0, csv.find('\n') + 1);
  std::istringstream names(head);
  std::size_t place = 0;
  for (std::string name; std::getline(names, name, ',');) {
    if (name == wanted || name.starts_with("\"" + wanted + " [")) {
      break;
    }
    ++place;
  }
  std::string text = head;
  for (const std::vector<double>& row : rows_of(csv)) {
    for (std::size_t column = 0; column < row.size(); ++column) {
      text += (column > 0 ? "," : "") +
              std::to_string((column == place ? 180.0 / M_PI : 1.0) * row[column]);
    }
    text += "\n";
  }
  return text;
}

TEST_F(Identify, UnitsAreCheckedOnSixAxesAndInThePlaneAndMayBeAccepted) {
  write("heavy.toml", "vehicle = \"" + kHeavy +
                          "\"\nrate_hz = 20.0\nlog = \"six_axes\"\nnoise = \"as_recorded\"\n"
                          "[excitation]\nmode = \"pilot\"\nperiod_s = [1.0, 6.0]\n"
                          "effort = [50, 50, 40, 6, 6, 4]\ndither = 0.1\n[[configurations]]\n"
                          "name = \"nominal\"\n[[phases]]\nconfiguration = \"nominal\"\n"
                          "duration_s = 120.0\n");
  testing::succeeded(run("simulate heavy.toml --out heavy.csv"));
  write("heavy.csv", in_degrees(content("heavy.csv"), "r"));
  const std::string six = "heavy.csv --vehicle " + kHeavy;
  expect_refused(six, "r is in degrees per second");
  testing::expect_refused(run("plan " + six + " --out refused"), "r is in degrees per second");
  testing::succeeded(run("identify " + six + " --units r=deg/s --out out"));

  simulate(kDagon, "as_recorded", "log.csv");
  write("log.csv", in_degrees(content("log.csv"), "rdot"));
  const std::string message = "rdot is in degrees per second squared";
  testing::expect_refused(run("plan log.csv --out refused"), message);
  expect_refused("log.csv", message);
  testing::succeeded(run("identify log.csv --accept implausible --out out"));
}

TEST_F(Identify, TheNextCommandHasEveryOptionOfThisOne) {
  simulate(kDagon, "as_recorded", "a log.csv");
  const std::string given =
      "--inputs u,v,r,th1,th2,th3 --targets udot,vdot,rdot --align none "
      "--only 0 --frame FRD --for kelpie";
  const Outcome outcome = testing::succeeded(run("identify 'a log.csv' --out out " + given));
  const std::size_t at = outcome.out.find("kelpie identify 'a log.csv' ");
  ASSERT_NE(at, std::string::npos) << outcome.out;
  const std::string next = outcome.out.substr(at + 7, outcome.out.find(" --mass", at) - at - 7);
  for (const char* const option : {"--inputs u,v,r,th1,th2,th3", "--targets udot,vdot,rdot",
                                   "--align none", "--only 0", "--frame FRD", "--for kelpie"}) {
    EXPECT_NE(next.find(option), std::string::npos) << option << "\n" << next;
  }
  EXPECT_NE(testing::succeeded(run(next + " --mass 70 --out again"))
                .out.find("next: kelpie simulate SCENARIO.toml --out log.csv"),
            std::string::npos);
  EXPECT_TRUE(exists("again/vehicle.toml"));
}

// The log with the commands that rotors with a time constant of 1 s would have needed.
std::string with_slow_rotors(const std::string& csv) {
  const double kept = std::exp(-0.25);
  const std::vector<std::vector<double>> rows = rows_of(csv);
  std::string text = csv.substr(0, csv.find('\n') + 1);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    for (std::size_t column = 0; column < rows[row].size(); ++column) {
      const bool is_command = column >= 5 && column < 8 && row > 0;  // th1, th2, th3
      const double value = rows[row][column];
      text += (column > 0 ? "," : "") +
              std::to_string(is_command ? (value - kept * rows[row - 1][column]) / (1.0 - kept)
                                        : value);
    }
    text += "\n";
  }
  return text;
}

TEST_F(Identify, TellsTimeConstantsAndSeesThroughThem) {
  simulate(kDagon, "as_recorded", "log.csv");
  write("sent.csv", with_slow_rotors(content("log.csv")));
  const auto sway_inertia = [&](const std::string& options) {
    const Outcome outcome = testing::succeeded(
        run("identify sent.csv --mass 70 --surge-added-mass 15 --verbose --out out " + options));
    EXPECT_EQ(outcome.out.find("Time constants of actuators") != std::string::npos,
              options.empty());
    const std::string yaml = content("out/parameters.yaml");
    const std::string before = R"("sway_inertia": {unit: "kg", state: "identified", value: )";
    const std::size_t at = yaml.find(before);
    EXPECT_NE(at, std::string::npos) << yaml;
    return at == std::string::npos ? 0.0 : std::stod(yaml.substr(at + before.size()));
  };
  const double blind = sway_inertia("--align none");
  EXPECT_EQ(content("out/parameters.yaml").find("actuators:"), std::string::npos);
  EXPECT_LT(std::abs(sway_inertia("") - 95.0), 0.5 * std::abs(blind - 95.0));
  const std::string yaml = content("out/parameters.yaml");
  for (const char* const command : {"th1", "th2", "th3"}) {
    const std::size_t at = yaml.find("\"" + std::string(command) + "\": {unit: s, lag: ");
    ASSERT_NE(at, std::string::npos) << yaml;
    const double lag = number_after(yaml, "lag: ", at);
    const double low = number_after(yaml, "interval90: [", at);
    const double high = number_after(yaml, ", ", yaml.find("interval90: [", at));
    EXPECT_GT(low, 0.3);
    EXPECT_LE(low, lag);
    EXPECT_LE(lag, high);
    EXPECT_LT(high, 1.5);
  }
  EXPECT_NE(content("out/identify.html").find("Time constants of actuators"), std::string::npos);
}

TEST_F(Identify, WithoutAScaleThereAreRatiosAndNoFilesOfSimulators) {
  simulate(kDagon, "as_recorded", "log.csv");
  const Outcome outcome = testing::succeeded(run("identify log.csv --out out"));
  EXPECT_NE(outcome.out.find("Ratios only"), std::string::npos) << outcome.out;
  EXPECT_NE(content("out/parameters.yaml").find("\"sway_inertia\": {unit: \"1\""),
            std::string::npos);
  EXPECT_FALSE(exists("out/vehicle.toml"));
  EXPECT_FALSE(exists("out/gazebo.sdf"));

  write("short.csv", content("log.csv").substr(0, content("log.csv").find("\n4,")));
  expect_refused("short.csv --split tail", "short.csv: too few rows: 0 windows of 5 s");
  expect_refused("log.csv --targets udot,vdot", "velocity of surge");
  expect_refused("log.csv --inputs u,v,r,th1,th2,t", "has no name of a thruster's speed");
  expect_refused("log.csv --inputs u,v,r,th1 --thrusters th4", "did you mean 'th1'?");
  expect_refused("log.csv --inputs u,v,r", "nothing drives the vehicle");
  expect_refused("log.csv --thrust th9=1", "'th9' is no thruster");
  expect_refused("log.csv --thrust th1=some", "--thrust: 'some' of 'th1' has to be a number > 0");
  expect_refused("log.csv --surge-added-mass 3", "needs --mass");
  expect_refused("log.csv --frame ned", "is no frame");
  expect_refused("log.csv --only 7", "log.csv has no configuration 7");
  write("bad.toml", "[body]\n");
  expect_refused("log.csv --vehicle bad.toml", "mass_kg");
  expect_refused("log.csv --inputs u,v,r,th1,th2 --targets udot,vdot,th3",
                 "th3: isn't the acceleration of 'r'");
}

// In the plane no thrust follows the supply: the option would be without effect.
TEST_F(Identify, TheSupplyIsRefusedInThePlane) {
  simulate(kDagon, "as_recorded", "log.csv");
  expect_refused("log.csv --volts th3", "--volts: has no effect in the plane");
  expect_refused("log.csv --volts th3 --vehicle " + kDagon, "--volts: has no effect in the plane");
  testing::expect_refused(run("plan log.csv --volts th3 --out refused"),
                          "--volts: has no effect in the plane");
}

TEST_F(Identify, SaysThatFinsAreNotInTheEquation) {
  simulate(kDagon, "as_recorded", "log.csv");
  std::string text = content("log.csv");
  write("fins.csv", text.replace(text.find("th3"), 3, "stern_plane2"));
  expect_refused("fins.csv", "stern_plane2: is a fin by its name");
  // A log that tells too little may do so because of what the equation lacks.
  text.replace(text.find("th2"), 3, "rudder");
  write("short.csv", text.substr(0, text.find("\n4,")));
  const Outcome outcome = run("identify short.csv --split tail --thrusters th1 --out refused");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("too few rows"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("; rudder, stern_plane2 are fins by their names: forces of fins"),
            std::string::npos)
      << outcome.err;
}

TEST_F(Identify, PrintsItsParametersAsJson) {
  simulate(kDagon, "as_recorded", "log.csv");
  const Outcome outcome = testing::succeeded(run("identify log.csv --out out --json"));
  const nlohmann::json found = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(found["format"], "kelpie-parameters");
  EXPECT_GT(found["held_out_r2"]["udot"]["vehicle"], 0.9);
  const std::string yaml = content("out/parameters.yaml");
  ASSERT_GT(found["parameters"].size(), 10U);
  for (const nlohmann::json& parameter : found["parameters"]) {
    EXPECT_NE(yaml.find("  \"" + parameter["name"].get<std::string>() + "\": {unit: "),
              std::string::npos)
        << parameter;
    EXPECT_TRUE(parameter["state"] == "not told by the log" || parameter["value"].is_number())
        << parameter;
  }
  EXPECT_EQ(found["correlations"]["names"].size(), found["correlations"]["matrix"].size());
}

}  // namespace
}  // namespace kelpie::identify_test
