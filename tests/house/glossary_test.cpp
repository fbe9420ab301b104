// SPDX-License-Identifier: Apache-2.0
// The glossary of docs/reference/architecture.md defines the noun at the end of every public
// type's name.

#include <gtest/gtest.h>

#include <cctype>
#include <cstddef>
#include <regex>
#include <set>
#include <string>

#include "house/sources.hpp"

namespace kelpie::glossary_test {
namespace {

const house_test::fs::path kGlossary = house_test::kRoot / "docs/reference/architecture.md";

// Lower-case words of the first column of the glossary's tables.
std::set<std::string> glossary() {
  static const std::regex kRow(R"(\| ([^|]+) \|.*)");
  static const std::regex kWord("[a-z]+");
  std::set<std::string> nouns;
  bool reached = false;
  for (const std::string& line : house_test::lines_of(kGlossary)) {
    reached |= line == "## Glossary";
    if (std::smatch row; reached && std::regex_match(line, row, kRow)) {
      const std::string cell = row[1];
      for (std::sregex_iterator it(cell.begin(), cell.end(), kWord), end; it != end; ++it) {
        nouns.insert(it->str());
      }
    }
  }
  return nouns;
}

// "stream" of "SampleStream".
std::string noun_of(const std::string& type) {
  const std::size_t last = type.find_last_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ");
  std::string noun = type.substr(last == std::string::npos ? 0 : last);
  noun.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(noun.front())));
  return noun;
}

bool is_defined(const std::string& noun, const std::set<std::string>& nouns) {
  return nouns.contains(noun) ||
         (noun.ends_with('s') && nouns.contains(noun.substr(0, noun.size() - 1)));
}

TEST(Glossary, DefinesTheNounOfEveryPublicType) {
  static const std::regex kType(R"((class|struct|enum class) (\w+)( final)?( :[^:].*)? \{.*)");
  const std::set<std::string> nouns = glossary();
  ASSERT_GT(nouns.size(), 40U);
  std::size_t seen = 0;
  for (const auto& file : house_test::files_below({"include"})) {
    for (const std::string& line : house_test::lines_of(file)) {
      if (std::smatch type; file.extension() == ".hpp" && std::regex_match(line, type, kType)) {
        ++seen;
        EXPECT_TRUE(is_defined(noun_of(type[2]), nouns))
            << type[2] << " of " << file << ": " << kGlossary << " lacks '" << noun_of(type[2])
            << "'";
      }
    }
  }
  EXPECT_GT(seen, 40U) << "types were not recognised";
}

TEST(Glossary, NounsAreTheLastWordOfAName) {
  EXPECT_EQ(noun_of("DynamicsModel"), "model");
  EXPECT_EQ(noun_of("Prediction"), "prediction");
  EXPECT_TRUE(is_defined("shares", {"share"}));
  EXPECT_FALSE(is_defined("shares", {"hare"}));
}

}  // namespace
}  // namespace kelpie::glossary_test
