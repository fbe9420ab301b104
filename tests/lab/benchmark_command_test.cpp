// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "cli/command.hpp"

namespace kelpie::benchmark_command_test {
namespace {

using testing::Outcome;

class BenchmarkCommand : public testing::CommandTest {
 protected:
  std::size_t lines_of(const std::string& file) const {
    const std::string text = content(file);
    return static_cast<std::size_t>(std::ranges::count(text, '\n'));
  }
  static std::size_t mentions(const std::string& text, const std::string& word) {
    std::size_t count = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
      ++count;
    }
    return count;
  }
};

TEST_F(BenchmarkCommand, WritesDrivesWithTheirManifest) {
  const Outcome outcome = testing::succeeded(run("benchmark --out drives --seed 3"));
  EXPECT_EQ(outcome.err, "");
  EXPECT_NE(outcome.out.find("7 simulated drives"), std::string::npos) << outcome.out;
  const std::string manifest = content("drives/simulated.toml");
  EXPECT_EQ(mentions(manifest, "[[data]]"), 7U);
  // The truth of a vehicle whose sensor fails is none of the measured accelerations.
  EXPECT_EQ(mentions(manifest, "truth = "), 6U);
  EXPECT_EQ(mentions(manifest, "\"changes\""), 6U);
  // Ten runs of 50 s at 4 Hz for each stretch of one vehicle, below a header.
  EXPECT_EQ(lines_of("drives/sim-nominal.csv"), 2001U);
  EXPECT_EQ(lines_of("drives/sim-thruster.csv"), 4001U);
  EXPECT_EQ(lines_of("drives/sim-return.csv"), 6001U);
  const std::string nominal = content("drives/sim-nominal.csv");
  EXPECT_EQ(nominal.substr(0, nominal.find('\n')),
            "t,conf,u,v,r,th1,th2,th3,udot,vdot,rdot,udot_true,vdot_true,rdot_true,run");
  // Vehicles are equal until the first change.
  EXPECT_EQ(content("drives/sim-drag.csv").substr(0, nominal.size()), nominal);
}

TEST_F(BenchmarkCommand, ASeedGivesTheSameDrives) {
  testing::succeeded(run("benchmark --out one --seed 2"));
  testing::succeeded(run("benchmark --out two --seed 2"));
  testing::succeeded(run("benchmark --out other --seed 4"));
  EXPECT_EQ(content("one/sim-return.csv"), content("two/sim-return.csv"));
  EXPECT_NE(content("one/sim-return.csv"), content("other/sim-return.csv"));
}

TEST_F(BenchmarkCommand, RefusesWhatIsNoPlanarVehicle) {
  testing::expect_refused(run("benchmark --out refused --scenario none.toml"), "none.toml");
  testing::expect_refused(
      run("benchmark --out refused --scenario " KELPIE_SOURCE_DIR "/scenarios/bluerov2_heavy.toml"),
      "bluerov2_heavy.toml");
  EXPECT_FALSE(exists("refused"));
}

}  // namespace
}  // namespace kelpie::benchmark_command_test
