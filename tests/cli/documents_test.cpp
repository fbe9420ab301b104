// SPDX-License-Identifier: Apache-2.0
// The manual and the completions, against the program's own help.

#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <set>
#include <vector>

#include "cli/command.hpp"
#include "support.hpp"

namespace kelpie {
namespace {

using testing::content_of;
using testing::kelpie;
using testing::TemporaryFolder;
using testing::write_text;

std::vector<std::string> matches(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  std::vector<std::string> found;
  for (std::sregex_iterator it(text.begin(), text.end(), regex), end; it != end; ++it) {
    found.push_back((*it)[1]);
  }
  return found;
}

// A line of a shell, run in `folder`; what it prints.
std::string shell(const TemporaryFolder& folder, const std::string& script) {
  write_text(folder / "script", script);
  const std::string command =
      "cd '" + folder.path().string() + "' && bash script >out 2>&1 </dev/null";
  const int status = std::system(command.c_str());  // NOLINT: the tests' own words
  return (WEXITSTATUS(status) == 0 ? "" : "failed: ") + content_of(folder / "out");
}

bool have(const TemporaryFolder& folder, const std::string& program) {
  return shell(folder, "command -v " + program + " >/dev/null").empty();
}

class Documents : public ::testing::Test {
 protected:
  std::vector<std::string> commands() {
    const std::string help = kelpie(folder_.path(), "--help").out;
    return matches(help.substr(help.find("Subcommands:")), "\n  ([a-z]+) ");
  }

  std::vector<std::string> options_of(const std::string& command) {
    return matches(kelpie(folder_.path(), command + " --help").out, "\n  (?:-h,)?(--[a-z-]+)");
  }

  // What bash offers at the end of a line, in alphabetical order.
  std::set<std::string> offered(const std::string& words, const std::string& current) {
    const std::string found =
        shell(folder_, "source <(" KELPIE_COMMAND " completion bash)\nCOMP_WORDS=(kelpie " + words +
                           " '" + current + "')\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n" +
                           "_kelpie\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n");
    const std::vector<std::string> lines = matches(found, "([^\n]+)\n");
    return {lines.begin(), lines.end()};
  }

  TemporaryFolder folder_;
};

TEST_F(Documents, EveryOptionOfEveryCommandIsInAllThree) {
  const std::string manual = kelpie(folder_.path(), "manual").out;
  const std::string bash = kelpie(folder_.path(), "completion bash").out;
  const std::string zsh = kelpie(folder_.path(), "completion zsh").out;
  ASSERT_GE(commands().size(), 13U);
  for (const std::string& command : commands()) {
    const std::size_t section = manual.find(".SS kelpie " + command + "\n");
    ASSERT_NE(section, std::string::npos) << command;
    const std::string text = manual.substr(section, manual.find("\n.S", section + 1) - section);
    const std::vector<std::string> words =
        matches(bash, "\n    '" + command + "'\\)[^\n]*\n[^\n]*?words '([^']*)'");
    ASSERT_EQ(words.size(), 1U) << command;
    const std::size_t arguments = zsh.find("\n    " + command + ")\n");
    ASSERT_NE(arguments, std::string::npos) << command;
    const std::string in_zsh = zsh.substr(arguments, zsh.find(";;", arguments) - arguments);
    for (const std::string& option : options_of(command)) {
      const std::string in_roff = std::regex_replace(option, std::regex("-"), "\\-");
      EXPECT_TRUE(option == "--help" || text.find("\\fB" + in_roff + "\\fR") != std::string::npos)
          << command << " " << option;
      EXPECT_NE((" " + words[0] + " ").find(" " + option + " "), std::string::npos)
          << command << " " << option;
      EXPECT_NE(in_zsh.find(option + "["), std::string::npos) << command << " " << option;
    }
  }
}

TEST_F(Documents, BashCompletesCommandsOptionsAndValues) {
  using Words = std::set<std::string>;
  EXPECT_EQ(offered("", "re"), Words({"reproduce"}));
  EXPECT_EQ(offered("learn", "--che"), Words({"--checkpoint-every"}));
  EXPECT_EQ(offered("learn --split", "r"), Words({"random"}));
  EXPECT_EQ(offered("learn --split =", "t"), Words({"tail"}));
  EXPECT_EQ(offered("convert bag --clock", ""), Words({"header", "receive"}));
  EXPECT_EQ(offered("learn --set", "gam"), Words({"gamma="}));
  EXPECT_EQ(offered("learn --seed", ""), Words());
  EXPECT_EQ(offered("completion", ""), Words({"bash", "zsh"}));
}

TEST_F(Documents, BashCompletesFilesAndFolders) {
  write_text(folder_ / "my log.csv", "");
  std::filesystem::create_directory(folder_ / "my bag");
  using Words = std::set<std::string>;
  EXPECT_EQ(offered("learn", "my"), Words({"my bag", "my log.csv"}));
  EXPECT_EQ(offered("learn --recover", "my"), Words({"my bag", "my log.csv"}));
  EXPECT_EQ(offered("learn --out", "my"), Words({"my bag"}));
  EXPECT_EQ(offered("learn --scales", "my"), Words({"my bag", "my log.csv"}));
  EXPECT_EQ(offered("learn --scales", "tr"), Words({"train"}));
}

TEST_F(Documents, ShellsAndRoffFindNoFault) {
  const std::string made = "kelpie() { " KELPIE_COMMAND " \"$@\"; }\n";
  EXPECT_EQ(shell(folder_, made + "kelpie completion bash | bash -n"), "");
  if (have(folder_, "zsh")) {
    EXPECT_EQ(shell(folder_, made + "kelpie completion zsh >_kelpie && zsh -n _kelpie"), "");
  }
  const std::string manual = kelpie(folder_.path(), "manual").out;
  EXPECT_TRUE(
      std::ranges::all_of(manual, [](char c) { return c == '\n' || (c >= ' ' && c < 127); }));
  if (have(folder_, "groff")) {
    EXPECT_EQ(shell(folder_, made + "kelpie manual | groff -man -ww -z"), "");
  }
}

TEST_F(Documents, AnUnknownShellIsRefused) {
  EXPECT_EQ(kelpie(folder_.path(), "completion tcsh").exit_code, 2);
}

}  // namespace
}  // namespace kelpie
