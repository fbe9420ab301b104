// SPDX-License-Identifier: Apache-2.0
// The help of all commands, and the manual page that is made of it.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "cli/shell.hpp"

namespace kelpie::help_test {
namespace {

using testing::have;
using testing::kelpie;
using testing::matches;
using testing::shell;

class Help : public testing::CommandTest {
 protected:
  std::string help(const std::string& arguments) { return run(arguments).out; }

  std::vector<std::string> commands() {
    const std::string text = help("--help");
    return matches(text.substr(text.find("Subcommands:")), "\n  ([a-z]+) ");
  }
};

TEST_F(Help, OfAllCommandsHasEveryOptionOfEachUnderItsName) {
  const std::string all = help("--help-all");
  ASSERT_GE(commands().size(), 11U);
  for (const std::string& command : commands()) {
    const std::size_t begin = all.find("\nkelpie " + command + " ");
    ASSERT_NE(begin, std::string::npos) << command;
    const std::string section = all.substr(begin, all.find("\n\nkelpie ", begin) - begin);
    for (const std::string& option : matches(help(command + " --help"), "\n  (--[a-z-]+)")) {
      EXPECT_NE(section.find("\n  " + option), std::string::npos) << command << " " << option;
    }
  }
  EXPECT_NE(all.find("\nkelpie memory show "), std::string::npos);
}

TEST_F(Help, MakesAManualPageWithoutFaultOrAPathOfTheBuild) {
  if (!have(folder_, "help2man")) {
    GTEST_SKIP() << "there is no help2man";
  }
  const std::string page =
      shell(folder_,
            "help2man --no-info --help-option=--help-all "
            "--include=" KELPIE_SOURCE_DIR "/cmake/kelpie.h2m " KELPIE_COMMAND);
  EXPECT_EQ(page.find(".\\\""), 0U) << page;
  EXPECT_EQ(matches(page, R"(\n\.SS "kelpie ([a-z]+) )").size(), commands().size() + 2);
  for (const char* const section : {"NAME", "SYNOPSIS", "OPTIONS", "COMMANDS", "EXAMPLES"}) {
    EXPECT_NE(page.find(std::string("\n.SH ") + section), std::string::npos) << section;
  }
  EXPECT_EQ(page.find(KELPIE_SOURCE_DIR), std::string::npos);
  write("kelpie.1", page);
  if (have(folder_, "groff")) {
    EXPECT_EQ(shell(folder_, "groff -man -ww -z kelpie.1"), "");
  }
}

}  // namespace
}  // namespace kelpie::help_test
