// SPDX-License-Identifier: Apache-2.0
// The help of all commands, and the manual page that is made of it.

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "chart/wording.hpp"
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
    const std::size_t begin = text.find("Every day:");
    return matches(text.substr(begin, text.find("\nExamples:") - begin), "\n  ([a-z]+) ");
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

TEST_F(Help, IsACommandToo) {
  for (const std::string command : {"", "learn", "memory show"}) {
    const std::string text = help(command + " --help");
    EXPECT_EQ(help("help " + command).substr(0, 500), text.substr(0, 500)) << command;
  }
}

TEST_F(Help, SaysWhereACommandIsThatThisProgramIsWithout) {
  for (const std::string command : {"bench", "reproduce"}) {
    testing::expect_refused(run(command + " --quick"),
                            "kelpie " + command + ": has moved to `kelpie-lab " + command + "`");
  }
}

TEST_F(Help, EndsWithTwoExamplesAndFitsTheTerminal) {
  for (const char* const width : {"64", "100"}) {
    ::setenv("COLUMNS", width, 1);  // NOLINT(concurrency-mt-unsafe): one thread
    for (const std::string& command : commands()) {
      const std::string text = help(command + " --help");
      const std::size_t examples = text.find("\nExamples:\n");
      ASSERT_NE(examples, std::string::npos) << command;
      EXPECT_EQ(matches(text.substr(examples), "\n  kelpie (" + command + " )").size(), 2U) << text;
      for (const std::string& line : matches(text.substr(0, examples), "([^\n]+)")) {
        const bool is_explained = line[0] == ' ' && line.find("  ", 3) != std::string::npos;
        if (is_explained) {
          EXPECT_LE(chart::code_points(line), std::stoul(width)) << command << "\n" << line;
        }
      }
    }
  }
  ::unsetenv("COLUMNS");  // NOLINT(concurrency-mt-unsafe): one thread
}

// The files of the examples are not here, but their options are.
TEST_F(Help, HasExamplesThatParse) {
  for (const std::string& command : commands()) {
    for (const std::string& example : matches(help(command + " --help"), "\n  kelpie ([^\n]+)")) {
      const std::string said =
          shell(folder_, "HOME=$PWD timeout 2 " KELPIE_COMMAND " " + example + " | head -c 100000");
      EXPECT_EQ(said.find("Run with --help"), std::string::npos) << example << "\n" << said;
    }
  }
}

TEST_F(Help, IsWhatACommandWithNothingToDoSays) {
  for (const auto& [words, usage, first] :
       {std::array{"", "Usage: kelpie [OPTIONS] SUBCOMMAND", "\nEvery day:\n  inspect "},
        std::array{"memory", "Usage: kelpie memory [OPTIONS] SUBCOMMAND", "\nSubcommands:\n"}}) {
    const testing::Outcome outcome = run(words);
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_NE(outcome.err.find(usage), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find(first), std::string::npos) << outcome.err;
  }
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
  EXPECT_EQ(matches(page, R"(\n\.SS "kelpie ([a-z]+) )").size(), commands().size() + 3);
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
