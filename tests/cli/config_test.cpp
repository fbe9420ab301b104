// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "cli/command.hpp"
#include "cli/shell.hpp"
#include "support.hpp"

namespace kelpie::config_test {
namespace {

using testing::content_of;
using testing::kelpie;
using testing::Outcome;
using testing::TemporaryFolder;
using testing::write_text;

TEST(Config, WhatItPrintsReadsBackToTheSame) {
  const TemporaryFolder folder;
  const Outcome paper = kelpie(folder.path(), "config --all --set preset=paper");
  ASSERT_EQ(paper.exit_code, 0) << paper.err;
  EXPECT_NE(paper.out.find("epsilon = [0.1, 0.001, 0.1]"), std::string::npos);
  write_text(folder / "paper.toml", paper.out);
  const Outcome again = kelpie(folder.path(), "config --all --config paper.toml");
  EXPECT_EQ(again.out, paper.out);
  EXPECT_EQ(again.err, "") << "a file that the program wrote gives no notes";
}

TEST(Config, WhatCannotBePrintedIsAFailure) {
  const TemporaryFolder folder;
  for (const std::string command : {"config", "--help", "config --markdown"}) {
    EXPECT_EQ(testing::shell(folder, KELPIE_COMMAND " " + command + " >/dev/full"),
              "failed: kelpie: standard output: cannot be written: No space left on device\n")
        << command;
  }
}

TEST(Config, TheShortListLosesNothingThatWasChanged) {
  const TemporaryFolder folder;
  const std::string changes = " --set preset=paper --set gamma=0.1,0.2,0.3 --set buffer=300";
  const std::string brief = kelpie(folder.path(), "config" + changes).out;
  EXPECT_NE(brief.find("\ncoverage = "), std::string::npos);
  EXPECT_EQ(brief.find("\ntolerance = "), std::string::npos) << "nobody asked for it";
  write_text(folder / "brief.toml", brief);
  const std::string all = kelpie(folder.path(), "config --all" + changes).out;
  EXPECT_NE(all.find("\ntolerance = "), std::string::npos);
  EXPECT_EQ(kelpie(folder.path(), "config --all --config brief.toml").out, all);
}

TEST(Config, SaysOnceWhichSettingHasNoEffect) {
  const TemporaryFolder folder;
  const Outcome set = kelpie(folder.path(), "config --set k=10 --set forget=fifo");
  EXPECT_EQ(set.exit_code, 0);
  EXPECT_EQ(set.err, "kelpie: setting k has no effect with forget = fifo\n");
  write_text(folder / "fifo.toml", "forget = \"fifo\"\nk = 3\nmemory = 4\n");
  EXPECT_EQ(kelpie(folder.path(), "config --config fifo.toml").err, set.err);
}

TEST(Config, AnOlderFileIsToldWhatToWriteInstead) {
  const TemporaryFolder folder;
  write_text(folder / "old.toml", "gamma = 0.1\ns = 1\n");
  const Outcome old = kelpie(folder.path(), "config --config old.toml");
  EXPECT_EQ(old.exit_code, 2);
  EXPECT_NE(old.err.find("old.toml:2: s: this setting was removed"), std::string::npos) << old.err;
}

TEST(Config, TheDocumentedTableIsTheProgramsOwn) {
  const TemporaryFolder folder;
  const std::string table = kelpie(folder.path(), "config --markdown").out;
  const std::string docs = content_of(KELPIE_SOURCE_DIR "/docs/settings.md");
  EXPECT_NE(docs.find(table), std::string::npos)
      << "docs/settings.md needs the output of `kelpie config --markdown`:\n"
      << table;
}

TEST(Config, HelpVersionAndUsageErrors) {
  const TemporaryFolder folder;
  EXPECT_EQ(kelpie(folder.path(), "--version").exit_code, 0);
  EXPECT_EQ(kelpie(folder.path(), "learn --help").exit_code, 0);
  EXPECT_EQ(kelpie(folder.path(), "").exit_code, 2);
  EXPECT_EQ(kelpie(folder.path(), "swim").exit_code, 2);
  EXPECT_EQ(kelpie(folder.path(), "learn").exit_code, 2);
  EXPECT_EQ(kelpie(folder.path(), "config --axes 0").exit_code, 2);
}

}  // namespace
}  // namespace kelpie::config_test
