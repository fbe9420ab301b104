// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "cli/command.hpp"

namespace kelpie::vehicle_test {
namespace {

using testing::Outcome;

const std::string kVehicles = KELPIE_SOURCE_DIR "/vehicles/";
const std::string kSize = " --mass 11 --size 0.46,0.34,0.25";

class Vehicle : public testing::CommandTest {
 protected:
  // The simulator drives the written vehicle.
  void expect_drive(const std::string& file, const std::string& effort) const {
    write("drive.toml", "vehicle = \"" + file +
                            "\"\nrate_hz = 10.0\nlog = \"six_axes\"\n[excitation]\n"
                            "mode = \"prbs\"\nperiod_s = [1.0, 3.0]\neffort = " +
                            effort +
                            "\n[[configurations]]\nname = \"nominal\"\n[[phases]]\n"
                            "configuration = \"nominal\"\nduration_s = 30.0\n");
    const Outcome outcome = run("simulate drive.toml --out drive.csv");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  }
};

TEST_F(Vehicle, WritesEveryFrameOfArduSubAndTellsWhichAxesItDrives) {
  const auto make = [&](const std::string& frame) {
    return testing::succeeded(
               run("vehicle new --frame " + frame + kSize + " --out " + frame + ".toml"))
        .out;
  };
  EXPECT_EQ(make("vectored_6dof"),
            "vectored_6dof.toml\n8 thrusters, 6 independent wrenches; driven by themselves: surge, "
            "sway, heave, roll, pitch, yaw\n");
  EXPECT_EQ(make("vectored_6dof_90deg"),
            "vectored_6dof_90deg.toml\n8 thrusters, 6 independent wrenches; driven by themselves: "
            "surge, sway, heave, roll, pitch, yaw\n");
  // Horizontal thrusters below the origin: surge and pitch come together.
  EXPECT_EQ(
      make("vectored"),
      "vectored.toml\n6 thrusters, 5 independent wrenches; driven by themselves: sway, heave, "
      "roll, yaw\n"
      "surge cannot be driven by itself: every push along this axis pushes another axis, too\n"
      "pitch cannot be driven by itself: every push along this axis pushes another axis, "
      "too\n");
  const std::string three = make("simplerov_3");
  EXPECT_NE(three.find("3 independent wrenches; driven by themselves: surge, heave, yaw\n"),
            std::string::npos);
  EXPECT_NE(three.find("sway cannot be driven: no thruster pushes along this axis\n"),
            std::string::npos);
  EXPECT_NE(make("simplerov_5").find("surge, sway, heave, roll, yaw"), std::string::npos);
  EXPECT_NE(make("bluerov1").find("6 thrusters, 6 independent"), std::string::npos);
  EXPECT_NE(make("simplerov_4").find("surge, heave, roll, yaw"), std::string::npos);
  expect_drive("vectored_6dof.toml", "[40, 40, 30, 4, 4, 3]");
  expect_drive("simplerov_3.toml", "[20, 0, 20, 0, 0, 2]");
}

// The published vehicle by the template, with the same body: the same file, but for comments.
TEST_F(Vehicle, TheTemplateAtTheSizeOfAHeavyIsTheHeavy) {
  testing::succeeded(run("vehicle new --frame vectored_6dof --size 0.457,0.436,0.254 --like " +
                         kVehicles + "bluerov2_heavy.toml --out heavy.toml"));
  testing::succeeded(
      run("vehicle new --frame vectored_6dof --size 0.457,0.436,0.254 --mass 13.5 "
          "--out similar.toml"));
  for (const std::string file : {"heavy.toml", "similar.toml"}) {
    const std::string text = content(file);
    for (const char* const line :
         {"mass_kg = 13.5", "inertia_kg_m2 = [0.26, 0.23, 0.37]", "net_buoyancy_n = 2.44",
          "added_mass = [6.36, 7.12, 18.68, 0.189, 0.135, 0.222]",
          "linear_damping = [13.7, 0, 33, 0, 0.8, 0]",
          "quadratic_damping = [141, 217, 190, 1.19, 0.47, 1.5]", "command = \"pwm\"",
          "[thrusters.m3]\nforward = 51.5\nreverse = 40.2\nposition_m = [-0.156, 0.111, 0.085]",
          "[thrusters.m6]\nforward = 51.5\nreverse = 40.2\nposition_m = [0.12, -0.218, 0]"}) {
      EXPECT_NE(text.find(line), std::string::npos) << file << ": " << line;
    }
  }
  EXPECT_NE(content("heavy.toml").find("exponent = 1.2"), std::string::npos);
  EXPECT_EQ(content("similar.toml").find("[battery]"), std::string::npos);
}

TEST_F(Vehicle, ThrustersComeFromAFileAndFromOptions) {
  write("frame.csv",
        "name,x,y,z,dx,dy,dz\nleft,0,-0.2,0,2,0,0\nright,0,0.2,0,1,0,0\ndown,0,0,0,0,0,1\n");
  Outcome outcome = testing::succeeded(
      run("vehicle new --thrusters frame.csv --like " + kVehicles +
          "bluerov2.toml --thrust 30,20 --dead-band 0 --thruster down=0.1,0,0,0,0,1 "
          "--thruster bow=0.3,0,0,0,1,0 --out own.toml"));
  EXPECT_NE(outcome.out.find("4 thrusters, 4 independent wrenches"), std::string::npos);
  EXPECT_NE(outcome.out.find("roll cannot be driven: no thruster"), std::string::npos);
  const std::string text = content("own.toml");
  EXPECT_NE(text.find("[thrusters.left]\nforward = 30\nreverse = 20\nposition_m = [0, -0.2, 0]\n"
                      "direction = [1, 0, 0]\n"),
            std::string::npos);
  EXPECT_NE(text.find("[thrusters.down]\nforward = 30\nreverse = 20\nposition_m = [0.1, 0, 0]"),
            std::string::npos);
  EXPECT_EQ(text.find("dead_band"), std::string::npos);
  outcome = testing::succeeded(run("vehicle check own.toml"));
  EXPECT_EQ(outcome.out.find("own.toml"), std::string::npos);
  EXPECT_NE(outcome.out.find("heave cannot be driven by itself"), std::string::npos);
  expect_drive("own.toml", "[20, 10, 20, 0, 0, 2]");
}

TEST_F(Vehicle, ChecksVehicleFiles) {
  EXPECT_NE(testing::succeeded(run("vehicle check " + kVehicles + "dagon.toml"))
                .out.find("5 thrusters, 5 independent wrenches"),
            std::string::npos);
  write("bad.toml", "[body]\nmas_kg = 1\n");
  testing::expect_refused(run("vehicle check bad.toml"),
                          "bad.toml:2: body.mas_kg: unknown key (did you mean 'mass_kg'?)");
}

TEST_F(Vehicle, BadInputEndsWithCode2AndWritesNothing) {
  expect_nothing_written("vehicle new", "--frame: give a frame of ArduSub");
  expect_nothing_written("vehicle new --frame vektored" + kSize, "did you mean 'vectored'?");
  expect_nothing_written("vehicle new --frame vectored --mass 11",
                         "--size: give length,width,height in m");
  expect_nothing_written("vehicle new --frame vectored --size 1,1,1", "--mass: give the mass");
  expect_nothing_written("vehicle new --frame vectored --mass -1 --size 1,1,1", "--mass");
  expect_nothing_written("vehicle new --frame vectored --mass 1 --size 1,nan,1", "--size");
  expect_nothing_written(
      "vehicle new --frame vectored --mass 11 --like " + kVehicles + "bluerov2.toml --size 1,1,1",
      "--mass: stands beside --like");
  expect_nothing_written(
      "vehicle new --frame vectored --size 1,1,1 --like " + kVehicles + "dagon.toml", "--like: ");
  expect_nothing_written("vehicle new --thruster m1=0,0,0,1,0" + kSize,
                         "'m1=0,0,0,1,0' must read NAME=x,y,z,dx,dy,dz");
  expect_nothing_written("vehicle new --thruster m1=0,0,0,0,0,0" + kSize, "must have a length");
  expect_nothing_written("vehicle new --thruster m1=0,0,inf,1,0,0" + kSize, "must be finite");
  expect_nothing_written("vehicle new --thruster m.1=0,0,0,1,0,0" + kSize, "no name of a thruster");
  write("frame.csv", "name,x,y,z,dx,dy\nm1,0,0,0,1,0\n");
  expect_nothing_written("vehicle new --thrusters frame.csv" + kSize, "dz");
  write("frame.csv", "name,x,y,z,dx,dy,dz\nm1,0,0,0,1,0,0\nm2,0,0,zero,1,0,0\n");
  expect_nothing_written("vehicle new --thrusters frame.csv" + kSize, "frame.csv:3: z");
  std::string many = "name,x,y,z,dx,dy,dz\n";
  for (int i = 1; i <= 17; ++i) {
    many += "m" + std::to_string(i) + ",0,0,0,1,0,0\n";
  }
  write("frame.csv", many);
  expect_nothing_written("vehicle new --thrusters frame.csv" + kSize, "thrusters: must be 1 to 16");
}

}  // namespace
}  // namespace kelpie::vehicle_test
