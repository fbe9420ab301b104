// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "cli/shell.hpp"

namespace kelpie::completion_test {
namespace {

using testing::have;
using testing::kelpie;
using testing::matches;
using testing::shell;
using Words = std::set<std::string>;

class Completion : public testing::CommandTest {
 protected:
  // What bash offers at the end of a line.
  Words offered(const std::string& words, const std::string& current) {
    const std::string found =
        shell(folder_, "source <(" KELPIE_COMMAND " completion bash)\nCOMP_WORDS=(kelpie " + words +
                           " '" + current + "')\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n" +
                           "_kelpie " KELPIE_COMMAND "\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n");
    const std::vector<std::string> lines = matches(found, "([^\n]+)\n");
    return {lines.begin(), lines.end()};
  }
};

TEST_F(Completion, BashCompletesCommandsOptionsAndValues) {
  EXPECT_EQ(offered("", "ro"), Words({"rollout"}));
  EXPECT_EQ(offered("", "compl"), Words({"completion"}));  // and not what only scripts ask
  EXPECT_EQ(offered("memory", ""), Words({"forget", "list", "show"}));
  EXPECT_EQ(offered("learn", "--che"), Words({"--checkpoint-every"}));
  EXPECT_EQ(offered("learn --split", "r"), Words({"random"}));
  EXPECT_EQ(offered("learn --split =", "t"), Words({"tail"}));
  EXPECT_EQ(offered("learn --split", "="),
            Words({"auto", "blocks", "column:", "none", "pieces", "random", "tail"}));
  EXPECT_EQ(offered("convert bag --clock", ""), Words({"header", "receive"}));
  EXPECT_EQ(offered("learn --set", "gam"), Words({"gamma="}));
  EXPECT_EQ(offered("learn --set gamma =", "0"), Words());
  EXPECT_EQ(offered("learn --seed", ""), Words());
  EXPECT_EQ(offered("completion", ""), Words({"bash", "zsh"}));
}

TEST_F(Completion, BashCompletesFilesAndFolders) {
  write("my log.csv", "");
  std::filesystem::create_directory(folder_ / "my bag");
  EXPECT_EQ(offered("learn", "my"), Words({"my bag", "my log.csv"}));
  EXPECT_EQ(offered("learn --recover", "my"), Words({"my bag", "my log.csv"}));
  EXPECT_EQ(offered("memory list", "my"), Words({"my bag", "my log.csv"}));
  EXPECT_EQ(offered("learn --out", "my"), Words({"my bag"}));
  EXPECT_EQ(offered("learn --scales", "my"), Words({"my bag", "my log.csv"}));
  EXPECT_EQ(offered("learn --scales", "tr"), Words({"train"}));
}

TEST_F(Completion, EveryOptionOfACommandIsOffered) {
  const std::string help = run("learn --help").out;
  const std::vector<std::string> options = matches(help, "\n  (?:-h,)?(--[a-z-]+)");
  ASSERT_GT(options.size(), 10U);
  EXPECT_EQ(offered("learn", "--"), Words(options.begin(), options.end()));
}

// What both scripts live on, and zsh alone: the value behind its option in one word, with meanings.
TEST_F(Completion, AValueMayStandInTheWordOfItsOption) {
  EXPECT_EQ(run("complete -- learn --split=t").out, "tail\n");
  EXPECT_EQ(run("complete -- memory li").out, "list\tAll past models, a line each\n");
}

TEST_F(Completion, ShellsFindNoFault) {
  EXPECT_EQ(shell(folder_, KELPIE_COMMAND " completion bash | bash -n"), "");
  if (have(folder_, "zsh")) {
    EXPECT_EQ(shell(folder_, KELPIE_COMMAND " completion zsh >_kelpie && zsh -n _kelpie"), "");
  }
}

TEST_F(Completion, AnUnknownShellIsRefused) {
  EXPECT_EQ(run("completion tcsh").exit_code, 2);
}

}  // namespace
}  // namespace kelpie::completion_test
