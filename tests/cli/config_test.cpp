// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "cli/command.hpp"
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
  const Outcome paper = kelpie(folder.path(), "config --set preset=paper");
  ASSERT_EQ(paper.exit_code, 0) << paper.err;
  EXPECT_NE(paper.out.find("epsilon = [0.1, 0.001, 0.1]"), std::string::npos);
  write_text(folder / "paper.toml", paper.out);
  EXPECT_EQ(kelpie(folder.path(), "config --config paper.toml").out, paper.out);
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
