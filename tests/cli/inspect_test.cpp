// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "support.hpp"

namespace kelpie::inspect_test {
namespace {

using testing::content_of;
using testing::kelpie;
using testing::Outcome;
using testing::TemporaryFolder;
using testing::write_text;

const std::string kBag = KELPIE_SOURCE_DIR "/tests/bag/fixtures/zstd.mcap";

TEST(Inspect, SaysWhatIsInABag) {
  const TemporaryFolder folder;
  const Outcome outcome = kelpie(folder.path(), "inspect " + kBag + " --json report.json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("24 messages, 2 topics"), std::string::npos);
  EXPECT_NE(outcome.out.find("/sample"), std::string::npos);
  const auto report = nlohmann::json::parse(content_of(folder / "report.json"));
  EXPECT_EQ(report.at("topics").at(0).at("messages"), 12);
}

TEST(Inspect, ADamagedBagIsRefusedOrRecoveredWithALossOnStderr) {
  const TemporaryFolder folder;
  const std::string whole = content_of(kBag);
  write_text(folder / "cut.mcap", whole.substr(0, whole.size() / 2));
  Outcome outcome = kelpie(folder.path(), "inspect cut.mcap --json report.json");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("cut.mcap: offset"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("--recover"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder / "report.json"));
  outcome = kelpie(folder.path(), "inspect cut.mcap --recover --json report.json");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.err.find("lost: cut.mcap: offset"), std::string::npos) << outcome.err;
  EXPECT_GT(nlohmann::json::parse(content_of(folder / "report.json")).at("loss_count"), 0);
}

TEST(Inspect, DoesNotReplaceItsBag) {
  const TemporaryFolder folder;
  const std::string bag = content_of(kBag);
  std::filesystem::create_directory(folder / "mission");
  write_text(folder / "mission" / "a.mcap", bag);
  for (const std::string given : {"mission/a.mcap", "mission"}) {
    const Outcome outcome = kelpie(folder.path(), "inspect " + given + " --json mission/a.mcap");
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_NE(outcome.err.find("mission/a.mcap: --json: would replace"), std::string::npos)
        << outcome.err;
    EXPECT_EQ(content_of(folder / "mission" / "a.mcap"), bag);
  }
}

TEST(Inspect, AMissingBagIsTheUsersFault) {
  const TemporaryFolder folder;
  const Outcome outcome = kelpie(folder.path(), "inspect none.mcap");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("none.mcap: cannot be read"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace kelpie::inspect_test
