// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "cli/command.hpp"
#include "cli/shell.hpp"

namespace kelpie::config_test {
namespace {

using testing::content_of;
using testing::kelpie;
using testing::Outcome;

using Config = testing::CommandTest;

TEST_F(Config, WhatItPrintsReadsBackToTheSame) {
  const Outcome paper = testing::succeeded(run("config --all --set preset=paper"));
  EXPECT_NE(paper.out.find("epsilon = [0.1, 0.001, 0.1]"), std::string::npos);
  write("paper.toml", paper.out);
  const Outcome again = run("config --all --config paper.toml");
  EXPECT_EQ(again.out, paper.out);
  EXPECT_EQ(again.err, "") << "a file that the program wrote gives no notes";
}

TEST_F(Config, WhatCannotBePrintedIsAFailure) {
  for (const std::string command : {"config", "--help", "config --markdown"}) {
    EXPECT_EQ(testing::shell(folder_, KELPIE_COMMAND " " + command + " >/dev/full"),
              "failed: kelpie: standard output: cannot be written: No space left on device\n")
        << command;
  }
}

TEST_F(Config, TheShortListLosesNothingThatWasChanged) {
  const std::string changes = " --set preset=paper --set gamma=0.1,0.2,0.3 --set buffer=300";
  const std::string brief = run("config" + changes).out;
  EXPECT_NE(brief.find("\ncoverage = "), std::string::npos);
  EXPECT_EQ(brief.find("\ntolerance = "), std::string::npos) << "nobody asked for it";
  write("brief.toml", brief);
  const std::string all = run("config --all" + changes).out;
  EXPECT_NE(all.find("\ntolerance = "), std::string::npos);
  EXPECT_EQ(run("config --all --config brief.toml").out, all);
}

TEST_F(Config, SaysOnceWhichSettingHasNoEffect) {
  const Outcome set = run("config --set k=10 --set forget=fifo");
  EXPECT_EQ(set.exit_code, 0);
  EXPECT_EQ(set.err, "kelpie: setting k has no effect with forget = fifo\n");
  write("fifo.toml", "forget = \"fifo\"\nk = 3\nmemory = 4\n");
  EXPECT_EQ(run("config --config fifo.toml").err, set.err);
}

TEST_F(Config, AnOlderFileIsToldWhatToWriteInstead) {
  write("old.toml", "gamma = 0.1\ns = 1\n");
  testing::expect_refused(run("config --config old.toml"),
                          "old.toml:2: s: this setting was removed");
}

TEST_F(Config, TheDocumentedTableIsTheProgramsOwn) {
  const std::string table = run("config --markdown").out;
  const std::string docs = content_of(KELPIE_SOURCE_DIR "/docs/reference/settings.md");
  EXPECT_NE(docs.find(table), std::string::npos)
      << "docs/reference/settings.md needs the output of `kelpie config --markdown`:\n"
      << table;
}

TEST_F(Config, HelpVersionAndUsageErrors) {
  EXPECT_EQ(run("--version").exit_code, 0);
  EXPECT_EQ(run("learn --help").exit_code, 0);
  EXPECT_EQ(run("").exit_code, 2);
  EXPECT_EQ(run("swim").exit_code, 2);
  EXPECT_EQ(run("learn").exit_code, 2);
  EXPECT_EQ(run("config --axes 0").exit_code, 2);
}

}  // namespace
}  // namespace kelpie::config_test
