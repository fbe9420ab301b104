// SPDX-License-Identifier: Apache-2.0
#include "simulator/scenario_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>

#include "fixtures.hpp"
#include "kelpie/core/error.hpp"
#include "simulator/toml_matrix.hpp"
#include "support.hpp"

namespace kelpie::scenario_file_test {
namespace {

std::string content(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

// A folder with a vehicle and a scenario of which one line can be spoilt.
class ScenarioFile : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_ / "vehicles");
    std::filesystem::create_directories(folder_ / "scenarios");
  }

  // Writes `name` with the first `old_text` replaced and notes the line where that is.
  void write(const std::string& name, const std::string& old_text = "",
             const std::string& new_text = "") {
    std::string text = content(testing::source_file(name));
    if (!old_text.empty()) {
      const std::size_t at = text.find(old_text);
      ASSERT_NE(at, std::string::npos) << old_text;
      line_ = 1 + static_cast<std::size_t>(std::count(
                      text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
      text.replace(at, old_text.size(), new_text);
    }
    std::ofstream(folder_ / name) << text;
  }

  Place place_of_error(const std::string& said) {
    try {
      simulator::read_scenario(folder_ / "scenarios/paper.toml");
      ADD_FAILURE() << "nothing was found wrong";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(said), std::string::npos) << error.what();
      return error.place();
    }
    return {};
  }

  void expect_vehicle_error(const std::string& old_text, const std::string& new_text,
                            const std::string& field, const std::string& said) {
    SCOPED_TRACE(new_text);
    write("scenarios/paper.toml");
    write("vehicles/dagon.toml", old_text, new_text);
    expect_place("dagon.toml", field, said);
  }

  void expect_scenario_error(const std::string& old_text, const std::string& new_text,
                             const std::string& field, const std::string& said) {
    SCOPED_TRACE(new_text);
    write("vehicles/dagon.toml");
    write("scenarios/paper.toml", old_text, new_text);
    expect_place("paper.toml", field, said);
  }

  void expect_place(const std::string& file, const std::string& field, const std::string& said) {
    const Place place = place_of_error(said);
    EXPECT_EQ(std::filesystem::path(place.file).filename(), file);
    EXPECT_EQ(place.field, field);
    EXPECT_EQ(place.line, line_);
  }

  testing::TemporaryFolder folder_;
  std::size_t line_ = 0;
};

TEST(TomlMatrix, AMatrixIsItsDiagonalOrItsRows) {
  const auto root = file::TomlNode::parse("a = [1, 2]\nb = [[1, 2], [3, 4]]\n", "a.toml");
  EXPECT_EQ(simulator::read_square<2>(root["a"]), (Eigen::Matrix2d{{1, 0}, {0, 2}}));
  EXPECT_EQ(simulator::read_square<2>(root["b"]), (Eigen::Matrix2d{{1, 2}, {3, 4}}));
}

TEST_F(ScenarioFile, EveryScenarioOfTheProjectIsGood) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(testing::source_file("scenarios"))) {
    EXPECT_NO_THROW(simulator::read_scenario(entry.path())) << entry.path();
    ++count;
  }
  EXPECT_GE(count, 6U);
}

TEST_F(ScenarioFile, ReadsThePapersScenario) {
  const simulator::Scenario scenario =
      simulator::read_scenario(testing::source_file("scenarios/paper.toml"));
  EXPECT_EQ(scenario.rate_hz, 1.0);
  EXPECT_EQ(scenario.duration_s(), 30000.0);
  ASSERT_EQ(scenario.configurations.size(), 3U);
  EXPECT_EQ(scenario.configurations[1].effectiveness(simulator::kSurgeRight), 0.5);
  EXPECT_EQ(scenario.configurations[1].effectiveness(simulator::kSurgeLeft), 1.0);
  EXPECT_EQ(scenario.configurations[2].damping_factor(5), 1.5);
  EXPECT_EQ(scenario.excitation.shortest_period_s, 20.0);
  EXPECT_EQ(scenario.excitation.longest_period_s, 70.0);
  EXPECT_EQ(scenario.noise.least_white_m_s, 0.0005);
}

TEST_F(ScenarioFile, ReadsPullsAndSensorFaults) {
  write("vehicles/dagon.toml");
  write("scenarios/diagnosis.toml", "effectiveness = { surge_right = 0.6 }",
        "pull_n = [-2, 0, 0]\nsensors = { scale = [1, 1, 1.2], frozen = [0, 1, 0] }");
  const simulator::Scenario scenario =
      simulator::read_scenario(folder_ / "scenarios" / "diagnosis.toml");
  EXPECT_EQ(scenario.configurations[1].pull_n.x(), -2.0);
  EXPECT_EQ(scenario.configurations[1].sensors.scale.z(), 1.2);
  EXPECT_EQ(scenario.configurations[1].sensors.bias, Eigen::Vector3d::Zero());
  EXPECT_EQ(scenario.configurations[1].sensors.frozen.y(), 1.0);
}

TEST_F(ScenarioFile, ReadsFullMatrices) {
  write("vehicles/dagon.toml", "added_mass = [15.0, 25.0, 60.0, 1.0, 6.0, 3.0]",
        "added_mass = [[15.0, 0, 0, 0, 0, 0], [0, 25, 0, 0, 0, 2.5], [0, 0, 60, 0, 0, 0], "
        "[0, 0, 0, 1, 0, 0], [0, 0, 0, 0, 6, 0], [0, 2.5, 0, 0, 0, 3]]");
  const simulator::VehicleParameters vehicle =
      simulator::read_vehicle(folder_ / "vehicles/dagon.toml");
  EXPECT_EQ(vehicle.added_mass(1, 5), 2.5);
  EXPECT_EQ(vehicle.added_mass(2, 2), 60.0);
}

TEST_F(ScenarioFile, MassMatrixMustBeSymmetricAndPositiveDefinite) {
  const std::string added = "added_mass = [15.0, 25.0, 60.0, 1.0, 6.0, 3.0]";
  const std::string field = "hydrodynamics.added_mass";
  expect_vehicle_error(added,
                       "added_mass = [[15.0, 1, 0, 0, 0, 0], [0, 25, 0, 0, 0, 0], "
                       "[0, 0, 60, 0, 0, 0], [0, 0, 0, 1, 0, 0], [0, 0, 0, 0, 6, 0], "
                       "[0, 0, 0, 0, 0, 3]]",
                       field, "symmetric");
  expect_vehicle_error(added, "added_mass = [-90.0, 25.0, 60.0, 1.0, 6.0, 3.0]", field,
                       "positive definite");
  expect_vehicle_error(added, "added_mass = [15.0, 25.0, 60.0]", field, "array of 6");
  expect_vehicle_error("inertia_kg_m2 = [2.0,", "inertia_kg_m2 = [-2.0,", "body.inertia_kg_m2",
                       "positive definite");
  expect_vehicle_error("mass_kg = 70.0", "mass_kg = 0.0", "body.mass_kg", "above zero");
}

TEST_F(ScenarioFile, DampingAndThrustersMustMakeSense) {
  expect_vehicle_error("linear_damping = [14.0", "linear_damping = [-14.0",
                       "hydrodynamics.linear_damping", "negative");
  expect_vehicle_error("quadratic_damping = [5.0", "quadratic_damping = [inf",
                       "hydrodynamics.quadratic_damping", "finite");
  expect_vehicle_error("forward = 0.0262", "forward = 0.0", "thrusters.surge_left.forward",
                       "above zero");
  expect_vehicle_error("direction = [1.0, 0.0", "direction = [2.0, 0.0",
                       "thrusters.surge_left.direction", "length 1");
  expect_vehicle_error("lag_s = 0.2", "lag_s = -0.2", "rotors.lag_s", "negative");
}

TEST_F(ScenarioFile, KeysMustBeKnownAndThere) {
  expect_vehicle_error("mass_kg = 70.0", "mas_kg = 70.0", "body.mas_kg", "did you mean 'mass_kg'?");
  write("scenarios/paper.toml");
  write("vehicles/dagon.toml", "[thrusters.sway]", "[thrusters.swaay]");
  EXPECT_EQ(place_of_error("needs the thrusters surge_left, surge_right, sway").field, "vehicle");
  expect_scenario_error("rate_hz = 1.0", "rat_hz = 1.0", "rat_hz", "did you mean 'rate_hz'?");
  expect_scenario_error("{ surge_right = 0.5 }", "{ surge_rigth = 0.5 }",
                        "configurations[1].effectiveness.surge_rigth",
                        "did you mean 'surge_right'?");
  expect_scenario_error("duration_s = 10000.0", "duration = 10000.0", "phases[0].duration",
                        "did you mean 'duration_s'?");
  write("scenarios/paper.toml", "rate_hz = 1.0\n", "");
  EXPECT_EQ(place_of_error("missing").field, "rate_hz");
}

TEST_F(ScenarioFile, NamesMustExist) {
  expect_scenario_error("configuration = \"more_damping\"", "configuration = \"mor_damping\"",
                        "phases[2].configuration", "did you mean 'more_damping'?");
  expect_scenario_error("noise = \"as_recorded\"", "noise = \"loud\"", "noise", "stress");
  expect_scenario_error("\"../vehicles/dagon.toml\"", "\"../vehicles/dragon.toml\"", "vehicle",
                        "dragon.toml");
  expect_scenario_error("name = \"more_damping\"", "name = \"nominal\"", "configurations[2].name",
                        "one before");
}

TEST_F(ScenarioFile, NumbersMustBeInRange) {
  expect_scenario_error("rate_hz = 1.0", "rate_hz = 0.0", "rate_hz", "above zero");
  expect_scenario_error("rate_hz = 1.0", "rate_hz = -1.0", "rate_hz", "above zero");
  expect_scenario_error("rate_hz = 1.0", "rate_hz = nan", "rate_hz", "finite");
  expect_scenario_error("rate_hz = 1.0", "rate_hz = 3.0", "rate_hz", "divide 100 Hz");
  expect_scenario_error("rate_hz = 1.0", "rate_hz = \"1\"", "rate_hz", "number");
  expect_scenario_error("seed = 1", "seed = -1", "seed", "whole number");
  expect_scenario_error("duration_s = 10000.0", "duration_s = 0.0", "phases[0].duration_s",
                        "above zero");
  expect_scenario_error("duration_s = 10000.0", "duration_s = 10.5", "phases[0].duration_s",
                        "sampling intervals");
  expect_scenario_error("duration_s = 10000.0", "ramp_s = 5.0\nduration_s = 10.0",
                        "phases[0].ramp_s", "first phase");
  expect_scenario_error("duration_s = 10000.0", "amplitude = 1.5\nduration_s = 10.0",
                        "phases[0].amplitude", "between 0 and 1");
  expect_scenario_error("damping_factor = [1.8", "damping_factor = [-1.8",
                        "configurations[2].damping_factor", "negative");
  expect_scenario_error("surge_right = 0.5", "surge_right = -0.5",
                        "configurations[1].effectiveness", "negative");
}

TEST_F(ScenarioFile, PeriodsMustRunUpwards) {
  expect_scenario_error("noise = \"as_recorded\"", "excitation = { period_s = [70.0, 20.0] }",
                        "excitation.period_s", "shortest first");
  expect_scenario_error("noise = \"as_recorded\"", "excitation = { mode = \"corelated\" }",
                        "excitation.mode", "did you mean 'correlated'?");
}

TEST_F(ScenarioFile, VehiclesWithAnyThrustersTellWhatIsWrong) {
  const auto expect = [&](const std::string& file, const std::string& old_text,
                          const std::string& new_text, const std::string& field,
                          const std::string& said) {
    SCOPED_TRACE(new_text);
    write("vehicles/bluerov2_heavy.toml");
    write("scenarios/bluerov2_heavy.toml");
    write(file, old_text, new_text);
    try {
      simulator::read_scenario(folder_ / "scenarios/bluerov2_heavy.toml");
      ADD_FAILURE() << "nothing was found wrong";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(said), std::string::npos) << error.what();
      EXPECT_EQ(error.place().field, field);
      EXPECT_EQ(std::filesystem::path(error.place().file).filename(),
                std::filesystem::path(file).filename());
      EXPECT_EQ(error.place().line, line_);
    }
  };
  const std::string vehicle = "vehicles/bluerov2_heavy.toml";
  expect(vehicle, "command = \"pwm\"", "command = \"pwmm\"", "rotors.command",
         "did you mean 'pwm'?");
  expect(vehicle, "delay_s = 0.02", "delay_s = 0.025", "rotors.delay_s", "whole number of steps");
  expect(vehicle, "dead_band = 0.0625", "dead_band = 1.0", "thrusters.m1.dead_band", "below 1");
  expect(vehicle, "forward = 51.5", "max_speed_rps = 1\nforward = 51.5",
         "thrusters.m1.max_speed_rps", "unknown key");
  expect(vehicle, "nominal_v = 16.0", "nominal_v = 0.0", "battery.nominal_v", "above zero");
  expect(vehicle, "empty_v = 13.2", "empty_v = 17.2", "battery.empty_v", "at most full_v");
  expect(vehicle, "exponent = 1.2", "exponent = -1.2", "battery.exponent", "between 0 and 3");
  const std::string scenario = "scenarios/bluerov2_heavy.toml";
  expect(scenario, "mode = \"pilot\"", "mode = \"pilt\"", "excitation.mode",
         "did you mean 'pilot'?");
  expect(scenario, "dither = 0.1", "dither = 1.1", "excitation.dither", "between 0 and 1");
  expect(scenario, "effort = [50, 50", "effort = [-50, 50", "excitation.effort", "none negative");
  expect(scenario, "log = \"six_axes\"", "log = \"six\"", "log", "six_axes");
  expect(scenario, "name = \"nominal\"", "effectiveness = { m9 = 0.5 }\nname = \"nominal\"",
         "configurations[0].effectiveness.m9", "unknown key");
}

TEST_F(ScenarioFile, APayloadMustLeaveAMassMatrix) {
  expect_scenario_error("effectiveness = { surge_right = 0.5 }", "payload = { mass_kg = -100.0 }",
                        "configurations[1].payload", "positive definite");
}

TEST_F(ScenarioFile, SyntaxErrorsAndMissingFilesAreToldWithTheirPlace) {
  expect_scenario_error("seed = 1", "seed = = 1", "", "");
  expect_vehicle_error("mass_kg = 70.0", "mass_kg = 70.0.0", "", "");
  EXPECT_THROW(simulator::read_scenario(folder_ / "nothing.toml"), InputError);
  EXPECT_THROW(simulator::read_scenario(folder_.path()), InputError);
}

}  // namespace
}  // namespace kelpie::scenario_file_test
