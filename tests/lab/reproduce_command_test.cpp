// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "cli/command.hpp"
#include "cli/running.hpp"
#include "file/out_folder.hpp"
#include "support.hpp"

namespace kelpie::reproduce_test {
namespace {

using testing::kelpie;
using testing::Outcome;
using testing::Running;
using testing::write_text;

// One configuration of 8,100 s: 1,620 rows in the quick version.
constexpr std::string_view kScenario = "vehicle = '" KELPIE_SOURCE_DIR
                                       "/vehicles/dagon.toml'\nrate_hz = 1.0\n"
                                       "[[configurations]]\nname = 'a'\n"
                                       "[[phases]]\nconfiguration = 'a'\nduration_s = 8100.0\n";

class Reproduce : public testing::CommandTest {
 protected:
  void SetUp() override {
    ::unsetenv("KELPIE_DATA_DIR");  // NOLINT: the log of this machine has no place in these tests
    std::filesystem::create_directory(folder_ / "scenarios");
    write_text(folder_ / "scenarios" / "tiny.toml", std::string(kScenario));
  }

  void expect_refused(const std::string& arguments, const std::string& message) {
    testing::expect_refused(run("reproduce --quick --out refused " + arguments), message);
    EXPECT_FALSE(exists("refused")) << arguments;
  }
};

TEST_F(Reproduce, WritesPageAndNumbersWithoutTheRealLog) {
  const Outcome outcome =
      testing::succeeded(run("reproduce --quick --scenario tiny --threads 1 --out out"));
  EXPECT_EQ(outcome.err, "");
  EXPECT_NE(outcome.out.find("simulation only"), std::string::npos);
  EXPECT_NE(outcome.out.find("off-line SVR"), std::string::npos);
  const auto json = parsed("out/reproduction.json");
  EXPECT_FALSE(json["real_log"].get<bool>());
  EXPECT_TRUE(json["plan"]["quick"].get<bool>());
  EXPECT_EQ(json["streams"].size(), 2U);
  const std::string page = content("out/reproduction.html");
  EXPECT_NE(page.find("everything below is simulation"), std::string::npos);

  // Drawn again without a measurement, the pages are the same.
  testing::succeeded(run("reproduce --draw out/reproduction.json --out again"));
  for (const char* const file : {"reproduction.html", "reproduction.md", "reproduction.json"}) {
    EXPECT_EQ(content("again/" + std::string(file)), content("out/" + std::string(file))) << file;
  }
}

TEST_F(Reproduce, RefusesBadInput) {
  expect_refused("--scenario tny", "'tny' is no scenario (did you mean 'tiny'?)");
  expect_refused("--scenarios nowhere", "holds no scenario");
  expect_refused("--data nowhere", "nowhere: --data: there is no dagon_config1.csv in it");
  expect_refused("--seeds -1", "--seeds");
  expect_refused("--seeds 0", "--seeds");
  expect_refused("--seed -1", "--seed");
  expect_refused("--threads -1", "--threads");
  expect_refused("--seeds 1001", "seeds: 1001 is out of range");
  write_text(folder_ / "scenarios" / "bad.toml", "rate_hz = 'fast'\n");
  expect_refused("--scenario bad", "bad.toml");
  write_text(folder_ / "other.json", "{\"format\": \"other\"}\n");
  expect_refused("--draw other.json", "other.json: format: has to be kelpie-reproduction");
}

TEST_F(Reproduce, FindsTheScenariosThatCameWithItFromAnyFolder) {
  std::filesystem::remove_all(folder_ / "scenarios");
  const Outcome outcome = run("reproduce --quick --scenario papr --out out");
  testing::expect_refused(outcome, "scenarios: 'papr' is no scenario (did you mean 'paper'?)");
}

TEST_F(Reproduce, AFolderThatAnotherRunWritesIntoIsRefused) {
  const file::OutFolder taken((folder_ / "out").string(), {"reproduction.html"});
  testing::expect_refused(run("reproduce --quick --scenario tiny --out out"), "another run");
}

TEST_F(Reproduce, CtrlCEndsItAndLeavesNothingBehind) {
  write_text(folder_ / "scenarios" / "long.toml",
             std::string(kScenario.substr(0, kScenario.rfind("8100"))) + "16000.0\n");
  Running work(folder_.path(), {"reproduce", "--quick", "--scenario", "long", "--out", "out"});
  ASSERT_TRUE(work.wait_for_text("reproducing [")) << work.terminal_text();
  work.press_ctrl_c();
  EXPECT_EQ(work.exit_code(), 1);
  EXPECT_NE(work.terminal_text().find("interrupted; nothing was written"), std::string::npos)
      << work.terminal_text();
  EXPECT_FALSE(exists("out"));
}

}  // namespace
}  // namespace kelpie::reproduce_test
