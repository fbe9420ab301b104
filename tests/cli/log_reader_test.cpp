// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cli/command.hpp"
#include "log/csv.hpp"
#include "support.hpp"

namespace kelpie::log_reader_test {
namespace {

using testing::content_of;
using testing::kelpie;
using testing::Outcome;
using testing::write_text;

const std::string kBag = KELPIE_SOURCE_DIR "/tests/bag/fixtures/zstd.mcap";

class LogReader : public ::testing::Test {
 protected:
  Outcome convert(const std::string& log, const std::string& config) {
    write_text(folder_ / "c.toml", config);
    return kelpie(folder_.path(), "convert " + log + " --config c.toml --out s.csv");
  }

  testing::TemporaryFolder folder_;
};

TEST_F(LogReader, TopicsOfABagBecomeSamples) {
  const Outcome outcome = convert(kBag,
                                  "[log]\nrate = 20\ndegree = 1\n"
                                  "[log.states]\nx = \"/cmd:linear.x\"\n"
                                  "[log.commands]\nspeed = \"/sample:speeds[0]\"\n"
                                  "[log.derived]\nxdot = \"d(x)\"\n");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const log::Table table = log::read_csv(folder_ / "s.csv");
  EXPECT_EQ(table.names, (std::vector<std::string>{"t", "x", "speed", "xdot"}));
  // x = t is sent every 0.1 s; speed = 10 t + 0.2 comes 0.03 s after it.
  std::size_t in_the_middle = 0;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double t = table.columns[0][row];
    EXPECT_NEAR(table.columns[1][row], t, 1e-6);
    EXPECT_NEAR(table.columns[2][row], std::floor(10.0 * t - 0.3 + 1e-6) + 0.5, 1e-6) << t;
    if (t > 0.3 && t < 0.8) {
      EXPECT_NEAR(table.columns[3][row], 1.0, 1e-6);
      ++in_the_middle;
    }
  }
  EXPECT_GE(in_the_middle, 9U);  // every 0.05 s
}

TEST_F(LogReader, ATableWithRawColumnsIsServedAlike) {
  std::string log = "stamp,speed_x,rpm\n";
  for (int k = 0; k < 200; ++k) {
    // rpm is told every fourth row only.
    log += std::to_string(0.05 * k) + "," + std::to_string(0.1 * k * 0.05) + "," +
           (k % 4 == 0 ? std::to_string(k) : "") + "\n";
  }
  write_text(folder_ / "log.csv", log);
  const Outcome outcome = convert("log.csv",
                                  "[log]\nrate = 10\ntime = \"stamp\"\n"
                                  "[log.states]\nu = \"speed_x\"\n[log.commands]\nn = \"rpm\"\n"
                                  "[log.derived]\nudot = \"d(u)\"\n");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("150 without value"), std::string::npos) << outcome.out;
  const log::Table table = log::read_csv(folder_ / "s.csv");
  EXPECT_NEAR(table.columns[3][20], 0.1, 1e-4);
  EXPECT_EQ(table.columns[2][20], 40.0);
}

TEST_F(LogReader, WhatIsWrongIsNamedWithItsPlace) {
  const std::string states = "[log.states]\nx = \"/cmd:linear.x\"\n";
  const std::vector<std::pair<std::string, std::string>> cases{
      {"[log]\nrate = 10\n", "zstd.mcap: is a bag; a file given by --config has to name"},
      {states, "c.toml: log.rate: is missing"},
      {"[log]\nrat = 10\n" + states, "c.toml:2: log.rat: unknown key (did you mean 'rate'?)"},
      {"[log]\nrate = 10\ntime = \"t\"\n" + states, "log.time: belongs to CSV files"},
      {"[log]\nrate = 10\nclock = \"haeder\"\n" + states, "did you mean 'header'?"},
      {"[log]\nrate = 10\n[log.states]\nx = \"/cmds:linear.x\"\n",
       "zstd.mcap: /cmds: there is no such topic (did you mean '/cmd'?)"},
      {"[log]\nrate = 10\n" + states + "[log.derived]\nxdot = \"x'\"\n",
       "c.toml:6: log.derived.xdot: 'x'' has to be the derivative of a column, as in \"d(u)\""},
      {"[log]\nrate = 10\n" + states + "[log.lag]\ny = 0.1\n", "log.lag.y: 'y' is no state"},
      {"[log]\nrate = 10\nlag = \"atuo\"\n[log.commands]\nx = \"/cmd:linear.x\"\n",
       "log.lag: has to be \"auto\" or a number of s"},
      {"[log]\nrate = 10\nclock = \"header\"\n" + states, "/cmd: geometry_msgs/msg/Twist has no "},
      {"[log]\nrate = 10\nvectors = [{columns = [\"x\"], from = \"FLU\", to = \"FRD\"}]\n" + states,
       "log.vectors.columns: has to be a list of three columns"},
  };
  for (const auto& [config, message] : cases) {
    const Outcome outcome = convert(kBag, config);
    EXPECT_EQ(outcome.exit_code, 2) << config;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "s.csv"));
  }
}

TEST_F(LogReader, TheExampleMakesSamplesOfARealBag) {
  const auto bag = testing::data_file("flatfish_bag");
  if (bag.empty()) {
    GTEST_SKIP() << "flatfish_bag is in neither $KELPIE_DATA_DIR nor ../shared/data";
  }
  const Outcome outcome = kelpie(folder_.path(), "convert " + bag.string() +
                                                     " --config " KELPIE_SOURCE_DIR
                                                     "/examples/flatfish.toml --out s.csv");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("silence"), std::string::npos);
  const log::Table table = log::read_csv(folder_ / "s.csv");
  std::size_t whole = 0;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    whole +=
        std::ranges::all_of(table.columns, [&](const auto& c) { return std::isfinite(c[row]); })
            ? 1
            : 0;
  }
  EXPECT_GT(whole, 800U);
  EXPECT_LT(whole, table.rows());
}

}  // namespace
}  // namespace kelpie::log_reader_test
