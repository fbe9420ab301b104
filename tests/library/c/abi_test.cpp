// SPDX-License-Identifier: Apache-2.0
// Programs in C that were compiled with the last release go on with this library: what kelpie.h
// declared then is declared still, with the same sizes. tests/library/c/abi.txt is the record; a
// release writes the record anew: KELPIE_RECORD_ABI=1 build/release/test_core
// --gtest_filter='Abi.*'.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

#include "kelpie/kelpie.h"

namespace kelpie::abi_test {
namespace {

const std::string kRecord = std::string(KELPIE_SOURCE_DIR) + "/tests/library/c/abi.txt";

std::string content(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

// The declarations of the header, each on a line, without comments and directives.
std::vector<std::string> declarations() {
  std::string text = content(std::string(KELPIE_SOURCE_DIR) + "/include/kelpie/kelpie.h");
  text = std::regex_replace(text, std::regex(R"(/\*[^*]*\*+([^/*][^*]*\*+)*/)"), " ");
  text = std::regex_replace(text, std::regex(R"((^|\n)#[^\n]*)"), "\n");
  text = std::regex_replace(text, std::regex(R"(extern "C" \{)"), " ");
  text = std::regex_replace(text, std::regex(R"(\s+)"), " ");
  std::vector<std::string> lines;
  std::string line;
  int depth = 0;
  for (const char c : text) {
    depth += c == '{' ? 1 : c == '}' ? -1 : 0;
    if (c == ';' && depth == 0) {
      lines.push_back(line.substr(line.find_first_not_of(' ')));
      line.clear();
    } else {
      line += c;
    }
  }
  return lines;
}

template <typename Struct>
std::string size_of(const char* name) {
  return std::string("sizeof ") + name + " = " + std::to_string(sizeof(Struct));
}

// Sizes of what a caller has on its own stack.
std::vector<std::string> sizes() {
  return {size_of<kelpie_status>("kelpie_status"),
          size_of<kelpie_verdict>("kelpie_verdict"),
          size_of<kelpie_decision>("kelpie_decision"),
          size_of<kelpie_prediction>("kelpie_prediction"),
          size_of<kelpie_cause>("kelpie_cause"),
          size_of<kelpie_finding>("kelpie_finding"),
          size_of<kelpie_axis_authority>("kelpie_axis_authority"),
          size_of<kelpie_thruster_effect>("kelpie_thruster_effect"),
          size_of<kelpie_command_path>("kelpie_command_path")};
}

// An enumeration may get further values at its end.
bool keeps(const std::string& present, const std::string& recorded) {
  const std::size_t end = recorded.find(" }");
  return present == recorded || (recorded.find("enum") != std::string::npos &&
                                 present.starts_with(recorded.substr(0, end) + ","));
}

TEST(Abi, WhatTheLastReleaseDeclaredIsDeclaredStill) {
  std::vector<std::string> now = declarations();
  ASSERT_GT(now.size(), 50U);
  std::ranges::copy(sizes(), std::back_inserter(now));
  if (std::getenv("KELPIE_RECORD_ABI") != nullptr) {  // NOLINT(concurrency-mt-unsafe)
    std::ofstream record(kRecord);
    for (const std::string& line : now) {
      record << line << '\n';
    }
  }
  std::ifstream record(kRecord);
  std::size_t recorded = 0;
  for (std::string line; std::getline(record, line); ++recorded) {
    EXPECT_TRUE(
        std::ranges::any_of(now, [&](const std::string& present) { return keeps(present, line); }))
        << "kelpie.h no longer declares: " << line;
  }
  EXPECT_GT(recorded, 50U);
}

}  // namespace
}  // namespace kelpie::abi_test
