// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <sstream>
#include <string>

#include "cli/command.hpp"
#include "support.hpp"

namespace kelpie::inspect_test {
namespace {

using testing::content_of;
using testing::kelpie;
using testing::Outcome;
using testing::write_text;

const std::string kBag = KELPIE_SOURCE_DIR "/tests/logs/bag/fixtures/zstd.mcap";

using Inspect = testing::CommandTest;

TEST_F(Inspect, SaysWhatIsInABag) {
  const Outcome outcome = testing::succeeded(run("inspect " + kBag + " --json report.json"));
  EXPECT_NE(outcome.out.find("24 messages, 2 topics"), std::string::npos);
  EXPECT_NE(outcome.out.find("/sample"), std::string::npos);
  const auto report = parsed("report.json");
  EXPECT_EQ(report.at("topics").at(0).at("messages"), 12);
}

TEST_F(Inspect, ADamagedBagIsRefusedOrRecoveredWithALossOnStderr) {
  const std::string whole = content_of(kBag);
  write("cut.mcap", whole.substr(0, whole.size() / 2));
  Outcome outcome = run("inspect cut.mcap --json report.json");
  testing::expect_refused(outcome, "cut.mcap: offset");
  EXPECT_NE(outcome.err.find("--recover"), std::string::npos);
  EXPECT_FALSE(exists("report.json"));
  outcome = run("inspect cut.mcap --recover --json report.json");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.err.find("lost: cut.mcap: offset"), std::string::npos) << outcome.err;
  EXPECT_GT(parsed("report.json").at("loss_count"), 0);
}

TEST_F(Inspect, WritesTwoFilesOfTwoNames) {
  testing::expect_refused(run("inspect " + kBag + " --json x --template ./x"), "--template");
  EXPECT_FALSE(exists("x"));
}

TEST_F(Inspect, DoesNotReplaceItsBag) {
  const std::string bag = content_of(kBag);
  std::filesystem::create_directory(folder_ / "mission");
  write_text(folder_ / "mission" / "a.mcap", bag);
  for (const std::string given : {"mission/a.mcap", "mission"}) {
    testing::expect_refused(run("inspect " + given + " --json mission/a.mcap"),
                            "mission/a.mcap: --json: would overwrite");
    EXPECT_EQ(content("mission/a.mcap"), bag);
  }
}

TEST_F(Inspect, TellsMistakesWithTheRemedyAndSucceeds) {
  std::istringstream rows(testing::little_log(1200));
  std::string text;
  std::string row;
  while (std::getline(rows, row)) {
    double t = 0.0;
    double u = 0.0;
    double n = 0.0;
    double a = 0.0;
    const int found = std::sscanf(row.c_str(), "%lf,%lf,%lf,%lf", &t, &u, &n, &a);  // NOLINT
    text += found == 4 ? fmt::format("{},{},{},{}\n", t, 100.0 * u, n, a) : row + "\n";
  }
  write("cm.csv", text);
  const Outcome outcome = testing::succeeded(run("inspect cm.csv --json report.json"));
  EXPECT_NE(outcome.out.find("MISTAKE: u is in cm/s, udot in m/s²"), std::string::npos)
      << outcome.out;
  EXPECT_EQ(parsed("report.json")["mistakes"][0]["remedy"], "--units u=cm/s converts");
}

TEST_F(Inspect, AMissingBagIsTheUsersFault) {
  testing::expect_refused(run("inspect none.mcap"), "none.mcap: cannot be read");
}

}  // namespace
}  // namespace kelpie::inspect_test
