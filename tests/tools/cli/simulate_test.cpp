// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

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

TEST_F(Simulate, BadInputEndsWithCode2AndItsPlace) {
  write("bad.toml", "rate_hz = 4.0\nrate_hzz = 4.0\n");
  const Outcome outcome = run("simulate bad.toml --out a.csv");
  testing::expect_refused(outcome, "bad.toml:2: rate_hzz: unknown key (did you mean 'rate_hz'?)");
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
  const Outcome outcome = run("simulate runaway.toml --out a.csv");
  testing::expect_refused(outcome, "runaway.toml: the simulation left finite numbers at t = ");
  EXPECT_FALSE(exists("a.csv"));
}

}  // namespace
}  // namespace kelpie::simulate_test
