// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "kelpie/core/random.hpp"
#include "kelpie/identify/planar_fit.hpp"

namespace kelpie::plan_test {
namespace {

using nlohmann::json;

const std::string kDagon = KELPIE_SOURCE_DIR "/vehicles/dagon.toml";
const std::string kHeavy = KELPIE_SOURCE_DIR "/vehicles/bluerov2_heavy.toml";

class Plan : public testing::CommandTest {
 protected:
  void SetUp() override {
    write("scenario.toml", "vehicle = \"" + kDagon +
                               "\"\nrate_hz = 4.0\nnoise = \"as_recorded\"\n[[configurations]]\n"
                               "name = \"nominal\"\n[[phases]]\nconfiguration = \"nominal\"\n"
                               "duration_s = 90.0\n");
    ASSERT_EQ(run("simulate scenario.toml --out log.csv").exit_code, 0);
  }

  json planned(const std::string& arguments, const std::string& out) const {
    testing::succeeded(run("plan log.csv " + arguments + " --out " + out));
    return parsed(out + "/plan.json");
  }
};

// Setpoints begin at 0, end at rest, keep the range of the log, and last as long as the plan says.
TEST_F(Plan, SetpointsAreThoseOfThePlan) {
  const json plan = planned("--thrust th1=0.0262 --seconds 40 --speed 0.6 --radius 6", "out");
  EXPECT_EQ(plan["format"], "kelpie-plan");
  EXPECT_LE(plan["duration_s"], 40.0);
  EXPECT_LE(plan["farthest_m"], 6.0);
  EXPECT_LE(plan["fastest_m_s"], 0.6);
  std::istringstream lines(content("out/plan.csv"));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "t,th1,th2,th3");
  double t = -1.0;
  std::vector<double> row(4);
  while (std::getline(lines, line)) {
    char comma = 0;
    std::istringstream cells(line);
    cells >> row[0] >> comma >> row[1] >> comma >> row[2] >> comma >> row[3];
    EXPECT_GT(row[0], t);
    t = row[0];
    EXPECT_LE(std::max(std::abs(row[1]), std::abs(row[2])), 12.6);
    EXPECT_LE(std::abs(row[3]), 11.0);
  }
  EXPECT_EQ(t, plan["duration_s"]);
  EXPECT_EQ(row, (std::vector<double>{t, 0.0, 0.0, 0.0}));
  EXPECT_FALSE(exists("out/plan.lua"));  // speeds are no pulses
  EXPECT_NE(content("out/plan.html").find("Countdown"), std::string::npos);
}

TEST_F(Plan, TheNextCommandHasTheOptionsOfTheLog) {
  std::string text = content("log.csv");
  write("log.csv", text.replace(text.find("th1,th2,th3"), 11, "a1,a2,a3"));
  const testing::Outcome outcome = testing::succeeded(
      run("plan log.csv --thrusters a1,a2,a3 --thrust a1=0.0262 --align none --seconds 10 "
          "--since 1 --out out"));
  const std::string wanted =
      "kelpie identify log.csv DRIVE --align none --thrusters a1,a2,a3 --thrust a1=0.0262   (";
  ASSERT_NE(outcome.out.find(wanted), std::string::npos) << outcome.out;
}

// The axis holds the aim, however far the drive stays above.
TEST_F(Plan, ThePictureReachesBelowTheAim) {
  planned("--tell surge_drag --percent 0.5 --seconds 10", "out");
  const std::string page = content("out/plan.html");
  const std::string axis = R"("label":"half width of the 90 % interval in %","log":true,"range":[)";
  const std::size_t at = page.find(axis);
  ASSERT_NE(at, std::string::npos);
  EXPECT_LT(std::stod(page.substr(at + axis.size())), 0.5);
}

TEST_F(Plan, WhatTheLogTellsNeedsNoManoeuvre) {
  const json plan = planned("--tell sway_drag --seconds 60", "out");
  EXPECT_EQ(plan["names"], (json{"sway_linear_drag", "sway_quadratic_drag"}));
  EXPECT_EQ(plan["countdown"].size(), 1U);
}

// What is known never shrinks, and the same log has the same plan.
TEST_F(Plan, TheCountdownFallsAndRepeats) {
  const json plan = planned("--tell surge_drag --seconds 60", "out");
  EXPECT_EQ(plan["names"], (json{"surge_linear_drag", "surge_quadratic_drag"}));
  ASSERT_GT(plan["countdown"].size(), 1U);
  for (std::size_t i = 1; i < plan["countdown"].size(); ++i) {
    const json& before = plan["countdown"][i - 1]["numbers"];
    const json& after = plan["countdown"][i]["numbers"];
    for (std::size_t k = 0; k < after.size(); ++k) {
      EXPECT_LE(after[k].get<double>(), 1.02 * before[k].get<double>());
    }
  }
  planned("--tell surge_drag --seconds 60", "again");
  EXPECT_EQ(content("out/plan.csv"), content("again/plan.csv"));
}

TEST_F(Plan, TwoCausesAreToldApart) {
  const json plan = planned("--apart th2,drag --seconds 60", "out");
  EXPECT_EQ(plan["number"], "nats");
  EXPECT_TRUE(plan["reached"]);
  EXPECT_GE(plan["countdown"].back()["numbers"][0], 5.0);
  const json larger = planned("--apart th2,drag --change 50 --seconds 60", "larger");
  EXPECT_LE(larger["duration_s"], plan["duration_s"]);
}

// Every cause that the option names is known, with a drive for each pair.
TEST_F(Plan, ForcesAndAllThrustersAreCauses) {
  for (const std::string pair :
       {"all_thrusters,surge_drag", "load,all_thrusters", "surge_force,th1",
        "sway_force,yaw_moment", "sway_drag,yaw_drag"}) {
    const json plan = planned("--apart " + pair + " --change 40 --seconds 40", pair);
    EXPECT_GT(plan["countdown"].back()["numbers"][0].get<double>(), 0.0) << pair;
  }
}

// Two thrusters at one place, the first of which loses half its thrust while both run alike.
std::string log_of_twins() {
  const PlanarVehicle sound{.sway_inertia = 1.2,
                            .yaw_inertia = 0.1,
                            .linear_drag = {0.16, 0.18, 0.015},
                            .quadratic_drag = {0.1, 0.7, 0.012},
                            .thrusters = {{"th1", 3e-4, 2.4e-4, 0.0, 0.32},
                                          {"th2", 3e-4, 2.4e-4, 0.0, -0.32},
                                          {"th3", 3e-4, 2.4e-4, 0.0, 0.32},
                                          {"th4", 4.2e-4, 3.2e-4, 1.57, -0.4}}};
  PlanarVehicle weak = sound;
  weak.thrusters[0].forward *= 0.5;
  weak.thrusters[0].reverse *= 0.5;
  RandomStream random(1, "twins");
  std::string text = "t,u,v,r,th1,th2,th3,th4,udot,vdot,rdot\n";
  PlanarVector velocity{};
  for (int row = 0; row < 2640; ++row) {
    const double t = 0.25 * row;
    const bool is_weak = row >= 2400;
    std::array<double, 4> speeds{
        6.0 * std::sin(0.23 * t) + 5.0 * std::sin(0.41 * t), 11.0 * std::sin(0.31 * t + 1.0),
        6.0 * std::sin(0.17 * t + 2.0) + 5.0 * std::sin(0.47 * t), 11.0 * std::sin(0.13 * t + 3.0)};
    speeds[2] = is_weak ? speeds[0] : speeds[2];
    const auto slope = [&] { return (is_weak ? weak : sound).acceleration(velocity, speeds); };
    text += fmt::format("{}", t);
    for (const double value : velocity) {
      text += fmt::format(",{:.6f}", value + 2e-4 * random.normal());
    }
    text += fmt::format(",{:.6f}", fmt::join(speeds, ","));
    for (const double value : slope()) {
      text += fmt::format(",{:.6f}", value + 1e-3 * random.normal());
    }
    text += "\n";
    for (int part = 0; part < 25; ++part) {
      const PlanarVector now = slope();
      for (std::size_t axis = 0; axis < now.size(); ++axis) {
        velocity[axis] += 0.01 * now[axis];
      }
    }
  }
  return text;
}

// The report gives the command for a drive that tells whose fault the loss is.
TEST_F(Plan, IsTheNextStepAfterAnAmbiguousChange) {
  write("twins.csv", log_of_twins());
  const testing::Outcome outcome = testing::succeeded(
      run("learn twins.csv --align none --split none --out learned" + testing::kFewSamples));
  const std::size_t begin = outcome.out.find("kelpie plan twins.csv --align none");
  ASSERT_NE(begin, std::string::npos) << outcome.out;
  const std::size_t end = outcome.out.find("   (", begin);
  const std::string command = outcome.out.substr(begin + 7, end - begin - 7);
  EXPECT_TRUE(command.ends_with(" --apart th1,th3 --change 50") ||
              command.ends_with(" --apart th3,th1 --change 50"))
      << command;
  EXPECT_NE(content("learned/report.html").find("--apart th"), std::string::npos);
  testing::succeeded(run(command + " --out out"));
  EXPECT_TRUE(parsed("out/plan.json")["reached"]);
}

// Pulses around 1500 us, within the bounds of depth and tilt, and a script for ArduSub.
TEST_F(Plan, SixAxesWithAVehicleFile) {
  write("heavy.toml", "vehicle = \"" + kHeavy +
                          "\"\nrate_hz = 20.0\nlog = \"six_axes\"\nnoise = \"as_recorded\"\n"
                          "[excitation]\nmode = \"pilot\"\nperiod_s = [1.0, 6.0]\n"
                          "effort = [50, 50, 40, 6, 6, 4]\ndither = 0.1\n[[configurations]]\n"
                          "name = \"nominal\"\n[[phases]]\nconfiguration = \"nominal\"\n"
                          "duration_s = 60.0\n");
  testing::succeeded(run("simulate heavy.toml --out heavy.csv"));
  const testing::Outcome outcome = testing::succeeded(
      run("plan heavy.csv --vehicle " + kHeavy +
          " --volts voltage --tell heave_drag,pitch_inertia --percent 0.5 --seconds 10 --depth 1 "
          "--tilt 20 --out out"));
  EXPECT_NE(outcome.out.find("of roll or pitch (bound 20)"), std::string::npos) << outcome.out;
  const json plan = parsed("out/plan.json");
  EXPECT_EQ(plan["names"], (json{"pitch_inertia", "heave_linear_drag", "heave_quadratic_drag"}));
  EXPECT_LE(plan["depth_m"], 1.0);
  EXPECT_LE(plan["tilt_rad"], 20.0 * 3.1416 / 180.0);
  ASSERT_GT(plan["countdown"].size(), 1U);
  std::istringstream lines(content("out/plan.csv"));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "t,m1,m2,m3,m4,m5,m6,m7,m8");
  std::string last;
  while (std::getline(lines, line)) {
    last = line;
    std::istringstream cells(line.substr(line.find(',') + 1));
    for (std::string cell; std::getline(cells, cell, ',');) {
      EXPECT_GE(std::stod(cell), 1100.0);
      EXPECT_LE(std::stod(cell), 1900.0);
    }
  }
  EXPECT_NE(last.find(",1500,1500,1500,1500,1500,1500,1500,1500"), std::string::npos) << last;
  EXPECT_TRUE(exists("out/plan.lua"));
  EXPECT_NE(content("out/plan.html").find("Depth and attitude"), std::string::npos);
  testing::expect_refused(run("plan log.csv --vehicle " + kHeavy + " --out refused"),
                          "is of six axes, and the log has no ");
  testing::expect_refused(run("plan heavy.csv --vehicle " + kHeavy + " --tell wings --out refused"),
                          "'wings' is no parameter");
}

// A vehicle with another load is another vehicle: the plan is of the first, or of --only.
TEST_F(Plan, IsOfOneConfiguration) {
  write("scenario.toml", "vehicle = \"" + kDagon +
                             "\"\nrate_hz = 4.0\nnoise = \"as_recorded\"\n[[configurations]]\n"
                             "name = \"nominal\"\n[[configurations]]\nname = \"fouled\"\n"
                             "damping_factor = [4, 4, 4, 4, 4, 4]\n[[phases]]\n"
                             "configuration = \"nominal\"\nduration_s = 90.0\n[[phases]]\n"
                             "configuration = \"fouled\"\nduration_s = 90.0\n");
  testing::succeeded(run("simulate scenario.toml --out both.csv"));
  const auto plan = [&](const std::string& arguments, const std::string& out) {
    testing::succeeded(run("plan " + arguments + " --align none --seconds 40 --out " + out));
    return content(out + "/plan.csv");
  };
  const std::string both = content("both.csv");
  std::size_t end = both.find('\n') + 1;
  while (both[both.find(',', end) + 1] == '0') {  // behind the time
    end = both.find('\n', end) + 1;
  }
  write("first.csv", both.substr(0, end));
  const std::string first = plan("first.csv --configuration conf", "first");
  EXPECT_EQ(plan("both.csv --configuration conf", "both"), first);
  EXPECT_EQ(plan("both.csv --configuration conf --only 0", "zero"), first);
  EXPECT_NE(plan("both.csv --configuration conf --only 1", "one"), first);
  testing::expect_refused(run("plan both.csv --configuration conf --only 7 --out refused"),
                          "has no configuration 7; it has 0, 1");
}

TEST_F(Plan, AnOutFolderIsTriedBeforeTheLog) {
  for (const std::string command : {"plan", "identify", "health"}) {
    const testing::Outcome outcome = run(command + " missing.csv --out log.csv/out");
    EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
    EXPECT_NE(outcome.err.find("log.csv/out"), std::string::npos) << outcome.err;
  }
}

TEST_F(Plan, MistakesAreRefused) {
  const auto refused = [&](const std::string& arguments, const std::string& message) {
    testing::expect_refused(run("plan log.csv " + arguments + " --out refused"), message);
    EXPECT_FALSE(exists("refused")) << arguments;
  };
  refused("--tell wings", "'wings' is no parameter");
  refused("--apart th2", "takes two causes");
  refused("--apart th2,th2", "names the same change twice");
  refused("--apart th2,wings", "'wings' changes nothing that is known");
  refused("--apart th2,force", "or a constant force: surge_force, sway_force, yaw_moment");
  refused("--apart th2,drag --tell drag", "two aims");
  refused("--range th9=-1:1", "'th9' is no thruster");
  refused("--range th1=1:2", "with rest between");
  refused("--range th1=a:b", "has to be NAME=LEAST:MOST");
  refused("--thrust th1=0", "has to be a number > 0");
  refused("--radius 0.1 --seconds 5", "leave room for no manoeuvre");
  refused("--depth 2", "bounds a drive on six axes, which takes --vehicle");
  refused("--tilt 20", "bounds a drive on six axes, which takes --vehicle");
  for (const char* const value : {"0", "nan", "-1", "1e9", "x"}) {
    for (const char* const option :
         {"--seconds", "--speed", "--radius", "--percent", "--change", "--depth", "--tilt"}) {
      refused(std::string(option) + " " + value, option);
    }
  }
  testing::expect_refused(run("plan missing.csv --out refused"), "missing.csv");
}

}  // namespace
}  // namespace kelpie::plan_test
