// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>

#include "cli/command.hpp"
#include "support.hpp"

namespace kelpie::opponents_command_test {
namespace {

class OpponentsCommand : public testing::CommandTest {};

TEST_F(OpponentsCommand, RefusesALogThatIsNotThePublishedOne) {
  testing::expect_refused(run("opponents --data . --out out"), "dagon_config1.csv: cannot be read");
  testing::write_text(folder_ / "dagon_config1.csv", "u,v,r,th1,udot\n1,2,3,4,5\n2,3,4,5,6\n");
  testing::expect_refused(run("opponents --data . --out out"), "the published protocol has 11567");
  EXPECT_FALSE(exists("out"));
}

TEST_F(OpponentsCommand, WritesThePublishedProtocolsFigures) {
  const auto log = testing::data_file("dagon_config1.csv");
  if (log.empty()) {
    GTEST_SKIP() << "the log of AUV Dagon is not here";
  }
  std::filesystem::copy(log, folder_ / "dagon_config1.csv");
  testing::succeeded(run("opponents --data . --every 400 --out out"));
  const auto json = parsed("out/opponents.json");
  EXPECT_TRUE(json["peers"].empty());
  ASSERT_EQ(json["published"].size(), 7U);
  EXPECT_GT(json["published"][0]["mean"].get<double>(), 0.62);
}

}  // namespace
}  // namespace kelpie::opponents_command_test
