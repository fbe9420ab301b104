// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "cli/command.hpp"

namespace kelpie::bench_test {
namespace {

using testing::kelpie;
using testing::little_log;
using testing::Outcome;

class BenchCommand : public testing::CommandTest {
 protected:
  void SetUp() override {
    write("tiny.toml", "vehicle = '" KELPIE_SOURCE_DIR
                       "/vehicles/dagon.toml'\nrate_hz = 1.0\n"
                       "[[configurations]]\nname = 'a'\n"
                       "[[phases]]\nconfiguration = 'a'\nduration_s = 600.0\n");
  }

  void expect_refused(const std::string& arguments, const std::string& message) {
    testing::expect_refused(run("bench --quick --out refused " + arguments), message);
    EXPECT_FALSE(exists("refused")) << arguments;
  }
};

TEST_F(BenchCommand, MeasuresALogAndASimulation) {
  write("log.csv", little_log(400));
  const Outcome outcome =
      testing::succeeded(run("bench log.csv --scenario tiny.toml --quick --window 40 --out out"));
  EXPECT_EQ(outcome.err, "");
  EXPECT_NE(outcome.out.find("tiny.toml (simulation) vdot"), std::string::npos) << outcome.out;
  const auto json = parsed("out/bench.json");
  EXPECT_EQ(json["axes"].size(), 4U);
  EXPECT_EQ(json["window"], 40);
  EXPECT_TRUE(json["axes"][0]["stream"].get<std::string>().ends_with("log.csv"));
}

TEST_F(BenchCommand, SoaksTheSolver) {
  const Outcome outcome = run("bench --soak 400");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("double: 400 updates, 0 fallbacks"), std::string::npos);
  EXPECT_NE(outcome.out.find("float: 400 updates, 0 fallbacks"), std::string::npos);
}

TEST_F(BenchCommand, TimesSingleUpdatesOfAModel) {
  const Outcome outcome = run("bench --updates 300 --budget 5");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("drives for 300 updates"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("≤ 7.5 ms"), std::string::npos) << outcome.out;
}

TEST_F(BenchCommand, RefusesWhatItCannotMeasure) {
  expect_refused("--scenario none.toml", "none.toml");
  expect_refused("none.csv --scenario tiny.toml", "none.csv");
  expect_refused("--scenario tiny.toml", "tiny.toml: has 600 rows; a window of 900 needs 1100");
  expect_refused("--scenario tiny.toml --window 5", "--window");
  expect_refused("--soak -1", "--soak");
  expect_refused("--budget 5", "--updates");
}

}  // namespace
}  // namespace kelpie::bench_test
