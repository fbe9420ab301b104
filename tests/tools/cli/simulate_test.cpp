// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "cli/command.hpp"

namespace kelpie::simulate_test {
namespace {

using testing::kelpie;
using testing::Outcome;

const std::string kSmall = KELPIE_SOURCE_DIR "/scenarios/small.toml";

using Simulate = testing::CommandTest;

TEST_F(Simulate, SameSeedSameBytesOtherSeedOtherBytes) {
  const Outcome outcome = testing::succeeded(run("simulate " + kSmall + " --out a.csv"));
  EXPECT_EQ(outcome.err, "");  // no progress bar without a terminal
  testing::succeeded(run("simulate " + kSmall + " --seed 1 --out b.csv"));
  testing::succeeded(run("simulate " + kSmall + " --seed 2 --out c.csv"));
  const std::string log = content("a.csv");
  EXPECT_EQ(log, content("b.csv"));
  EXPECT_NE(log, content("c.csv"));
  const std::string header =
      "t,conf,u,v,r,th1,th2,th3,udot,vdot,rdot,udot_true,vdot_true,rdot_true\n";
  EXPECT_EQ(log.substr(0, header.size()), header);
}

// Numbers of an earlier release: an extension of the simulator leaves the drives of existing files
// as they were. Only where the compiler fuses no multiplication with an addition.
#ifdef __x86_64__
TEST_F(Simulate, ExistingFilesGiveTheBitsTheyGave) {
  testing::succeeded(run("simulate " + kSmall + " --out small.csv"));
  const std::string log = content("small.csv");
  const std::string last =
      "750,0,-0.061112367007444705,-0.11503066631111304,0.551596089604699,4.9655246927520045,"
      "7.325125958663577,10.871614563640877,-0.03735914148223679,0.00482527192428947,"
      "0.10840025109585971,-0.03648634403002105,0.01146597484619656,0.10268777610700501\n";
  EXPECT_EQ(log.substr(log.size() - last.size()), last);
}
#endif

TEST_F(Simulate, SixAxesOfABlueRovWithVoltageAndPulses) {
  const std::string heavy = KELPIE_SOURCE_DIR "/scenarios/bluerov2_heavy.toml";
  testing::succeeded(run("simulate " + heavy + " --out a.csv"));
  testing::succeeded(run("simulate " + heavy + " --seed 1 --out b.csv"));
  const std::string log = content("a.csv");
  EXPECT_EQ(log, content("b.csv"));
  const std::string header =
      "t [s],conf,u [m/s],v [m/s],w [m/s],p [rad/s],q [rad/s],r [rad/s],phi [rad],theta [rad],"
      "psi [rad],m1 [us],m2 [us],m3 [us],m4 [us],m5 [us],m6 [us],m7 [us],m8 [us],voltage [V],"
      "udot [m/s^2],vdot [m/s^2],wdot [m/s^2],pdot [rad/s^2],qdot [rad/s^2],rdot [rad/s^2],"
      "udot_true [m/s^2],vdot_true [m/s^2],wdot_true [m/s^2],pdot_true [rad/s^2],"
      "qdot_true [rad/s^2],rdot_true [rad/s^2]\n";
  std::string first = log.substr(0, log.find('\n') + 1);
  std::erase(first, '"');
  EXPECT_EQ(first, header);
  EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), 24001);
}

TEST_F(Simulate, BadInputEndsWithCode2AndItsPlace) {
  write("bad.toml", "rate_hz = 4.0\nrate_hzz = 4.0\n");
  testing::expect_refused(run("simulate bad.toml --out a.csv"),
                          "bad.toml:2: rate_hzz: unknown key (did you mean 'rate_hz'?)");
  EXPECT_EQ(run("simulate nothing.toml --out a.csv").exit_code, 2);
  EXPECT_EQ(run("simulate " + kSmall).exit_code, 2);
  EXPECT_EQ(run("simulate " + kSmall + " --seed -1 --out a.csv").exit_code, 2);
  EXPECT_FALSE(exists("a.csv"));
  EXPECT_EQ(run("simulate bad.toml --out bad.toml").exit_code, 2);
  EXPECT_EQ(content("bad.toml"), "rate_hz = 4.0\nrate_hzz = 4.0\n");
}

TEST_F(Simulate, ARunawayEndsWithCode2AndNoFile) {
  write("runaway.toml", "vehicle = \"" KELPIE_SOURCE_DIR
                        "/vehicles/dagon.toml\"\n"
                        "rate_hz = 1.0\n"
                        "[[configurations]]\n"
                        "name = \"stiff\"\n"
                        "damping_factor = [1e6, 1e6, 1e6, 1e6, 1e6, 1e6]\n"
                        "[[phases]]\n"
                        "configuration = \"stiff\"\n"
                        "duration_s = 100.0\n");
  testing::expect_refused(run("simulate runaway.toml --out a.csv"),
                          "runaway.toml: the simulation left finite numbers at t = ");
  EXPECT_FALSE(exists("a.csv"));
}

}  // namespace
}  // namespace kelpie::simulate_test
