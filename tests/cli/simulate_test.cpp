// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "cli/command.hpp"
#include "support.hpp"

namespace kelpie::simulate_test {
namespace {

using testing::content_of;
using testing::kelpie;
using testing::Outcome;
using testing::TemporaryFolder;
using testing::write_text;

const std::string kSmall = KELPIE_SOURCE_DIR "/scenarios/small.toml";

TEST(Simulate, SameSeedSameBytesOtherSeedOtherBytes) {
  const TemporaryFolder folder;
  const Outcome outcome = kelpie(folder.path(), "simulate " + kSmall + " --out a.csv");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");  // no progress bar without a terminal
  ASSERT_EQ(kelpie(folder.path(), "simulate " + kSmall + " --seed 1 --out b.csv").exit_code, 0);
  ASSERT_EQ(kelpie(folder.path(), "simulate " + kSmall + " --seed 2 --out c.csv").exit_code, 0);
  const std::string log = content_of(folder / "a.csv");
  EXPECT_EQ(log, content_of(folder / "b.csv"));
  EXPECT_NE(log, content_of(folder / "c.csv"));
  const std::string header =
      "t,conf,u,v,r,th1,th2,th3,udot,vdot,rdot,udot_true,vdot_true,rdot_true\n";
  EXPECT_EQ(log.substr(0, header.size()), header);
}

TEST(Simulate, BadInputEndsWithCode2AndItsPlace) {
  const TemporaryFolder folder;
  write_text(folder / "bad.toml", "rate_hz = 4.0\nrate_hzz = 4.0\n");
  const Outcome outcome = kelpie(folder.path(), "simulate bad.toml --out a.csv");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("bad.toml:2: rate_hzz: unknown key (did you mean 'rate_hz'?)"),
            std::string::npos)
      << outcome.err;
  EXPECT_EQ(kelpie(folder.path(), "simulate nothing.toml --out a.csv").exit_code, 2);
  EXPECT_EQ(kelpie(folder.path(), "simulate " + kSmall).exit_code, 2);
  EXPECT_EQ(kelpie(folder.path(), "simulate " + kSmall + " --seed -1 --out a.csv").exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.csv"));
  EXPECT_EQ(kelpie(folder.path(), "simulate bad.toml --out bad.toml").exit_code, 2);
  EXPECT_EQ(content_of(folder / "bad.toml"), "rate_hz = 4.0\nrate_hzz = 4.0\n");
}

TEST(Simulate, ARunawayEndsWithCode1AndNoFile) {
  const TemporaryFolder folder;
  write_text(folder / "runaway.toml", "vehicle = \"" KELPIE_SOURCE_DIR
                                      "/vehicles/dagon.toml\"\n"
                                      "rate_hz = 1.0\n"
                                      "[[configurations]]\n"
                                      "name = \"stiff\"\n"
                                      "damping_factor = [1e6, 1e6, 1e6, 1e6, 1e6, 1e6]\n"
                                      "[[phases]]\n"
                                      "configuration = \"stiff\"\n"
                                      "duration_s = 100.0\n");
  const Outcome outcome = kelpie(folder.path(), "simulate runaway.toml --out a.csv");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.err.find("left finite numbers at t = "), std::string::npos) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "a.csv"));
}

}  // namespace
}  // namespace kelpie::simulate_test
