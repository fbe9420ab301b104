// SPDX-License-Identifier: Apache-2.0
#include "fleet/log_pattern.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::log_pattern_test {
namespace {

namespace fs = std::filesystem;

using testing::message_of;
using testing::TemporaryFolder;
using testing::write_text;

class LogPattern : public ::testing::Test {
 protected:
  LogPattern() : root_(folder_ / "a [strange]* folder") {
    for (const char* const file :
         {"a/1.csv", "a/2.csv", "a/b/3.csv", "a/b/c/4.csv", "a/b/c/5.bag", "a/.hidden/6.csv",
          "a/.7.csv", "d/8.csv", "top.csv", "d/run_9.csv", "d/[10].csv"}) {
      fs::create_directories((root_ / file).parent_path());
      write_text(root_ / file, "");
    }
  }

  std::vector<std::string> found(const std::string& pattern) const {
    std::vector<std::string> names;
    for (const fleet::MatchedLog& log : fleet::LogPattern(pattern).find(root_)) {
      names.push_back(log.file.lexically_relative(root_).string());
    }
    std::ranges::sort(names);
    return names;
  }

  // What bash makes of it.
  std::vector<std::string> by_bash(const std::string& pattern) const {
    const std::string command = "cd '" + root_.string() +
                                R"(' && bash -O globstar -O nullglob -c 'printf "%s\n" )" +
                                pattern + "' > ../names";
    EXPECT_EQ(std::system(command.c_str()), 0);  // NOLINT: the patterns are the test's own
    std::ifstream stream(folder_ / "names");
    std::vector<std::string> names;
    for (std::string name; std::getline(stream, name);) {
      if (!name.empty()) {
        names.push_back(name);
      }
    }
    std::ranges::sort(names);
    return names;
  }

  TemporaryFolder folder_;
  fs::path root_;
};

TEST_F(LogPattern, FindsWhatAShellFinds) {
  for (const char* const pattern :
       {"a/*.csv", "*/*.csv", "**/*.csv", "a/**/*.csv", "a/**/c/*", "*", "*/b", "a/b/?.csv",
        "[ad]/[0-9].csv", "**/b/*.csv", "no/*.csv", "top.csv", "d/\\[10\\].csv", "**/c"}) {
    EXPECT_EQ(found(pattern), by_bash(pattern)) << pattern;
  }
}

TEST_F(LogPattern, NamesWhatStandsInBraces) {
  const auto named = [&](const std::string& pattern) {
    std::vector<std::string> names;
    for (const fleet::MatchedLog& log : fleet::LogPattern(pattern).find(root_)) {
      names.push_back(log.vehicle + ":" + log.mission);
    }
    std::ranges::sort(names);
    return join_text(names, " ");
  };
  EXPECT_EQ(named("{vehicle}/{mission}.csv"), "a:1 a:2 d:8 d:[10] d:run_9");
  EXPECT_EQ(named("{vehicle}/run_{mission}.csv"), "d:9");
  EXPECT_EQ(named("{vehicle}/**/{mission}.csv"), "a:1 a:2 a:3 a:4 d:8 d:[10] d:run_9");
  EXPECT_EQ(named("a/**/{vehicle}/*.bag"), "c:");
  EXPECT_EQ(named("d/{vehicle}_{mission}.csv"), "run:9");
  EXPECT_EQ(named("d/*n_{mission}.c?v"), ":9");
  // The folder before an absolute pattern is the pattern's own.
  EXPECT_EQ(fleet::LogPattern((folder_ / "*" / "d").string() + "/{mission}_9.csv")
                .find("/nowhere")
                .at(0)
                .mission,
            "run");
}

TEST_F(LogPattern, RefusesWhatItCouldNotName) {
  const auto refused = [](const std::string& pattern) {
    return message_of<InputError>([&] { fleet::LogPattern{pattern}; });
  };
  EXPECT_NE(refused("**/a/**/b").find("may have one **"), std::string::npos);
  EXPECT_NE(refused("a/**").find("with a name after it"), std::string::npos);
  EXPECT_NE(refused("a**/b").find("between slashes"), std::string::npos);
  EXPECT_NE(refused("{boat}/b").find("{vehicle} or {mission}"), std::string::npos);
  EXPECT_NE(refused("{vehicle}*/b").find("beside {vehicle}"), std::string::npos);
  EXPECT_NE(refused("{vehicle}_{vehicle}").find("stands twice"), std::string::npos);
  EXPECT_NE(refused("[ab]_{vehicle}").find("no [ and"), std::string::npos);
  EXPECT_NE(refused("{vehicle/b").find("a { has no }"), std::string::npos);
  EXPECT_NE(refused("{vehicle}{mission}").find("beside {vehicle}"), std::string::npos);
  EXPECT_NE(refused("").find("has to be a path"), std::string::npos);
  EXPECT_NE(refused("//").find("has to be a path"), std::string::npos);
}

}  // namespace
}  // namespace kelpie::log_pattern_test
