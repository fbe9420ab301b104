// SPDX-License-Identifier: Apache-2.0
// Pages of docs/: links and citations that resolve, mentions in sources, and how many pages there
// are and how far from the README.

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "house/sources.hpp"

namespace kelpie::docs_test {
namespace {

using house_test::kRoot;
using house_test::lines_of;
using house_test::fs::path;

constexpr std::size_t kMostPages = 26;
constexpr int kMostClicks = 3;

struct Link {
  std::string text;
  path target;  // relative to the root of the tree
  std::string anchor;
};

std::vector<path> pages_below(const path& folder) {
  std::vector<path> pages;
  for (const auto& entry : house_test::fs::recursive_directory_iterator(kRoot / folder)) {
    if (entry.path().extension() == ".md") {
      pages.push_back(entry.path().lexically_relative(kRoot));
    }
  }
  return pages;
}

// Every page that people read: docs/, READMEs, and the pages at the root.
std::vector<path> all_pages() {
  std::vector<path> pages{"README.md", "CONTRIBUTING.md", "CHANGELOG.md"};
  for (const char* folder : {"docs", "src", "include", "lab", "examples", "python"}) {
    const std::vector<path> below = pages_below(folder);
    pages.insert(pages.end(), below.begin(), below.end());
  }
  return pages;
}

// The page without code, whose brackets are no links.
std::vector<std::string> prose_of(const path& page) {
  static const std::regex kCode("`[^`]*`");
  std::vector<std::string> prose;
  bool is_code = false;
  for (const std::string& line : house_test::lines_of(kRoot / page)) {
    is_code = is_code != line.starts_with("```");
    const bool has_code = line.find('`') != std::string::npos;
    prose.push_back(is_code ? "" : has_code ? std::regex_replace(line, kCode, "X") : line);
  }
  return prose;
}

std::vector<Link> links_of(const path& page) {
  static const std::regex kLink(R"(\[([^\]]*)\]\(([^)\s#]*)(#([^)\s]+))?\))");
  static const std::regex kElsewhere("[a-z]+:.*");
  std::vector<Link> links;
  for (const std::string& line : prose_of(page)) {
    if (line.find("](") == std::string::npos) {
      continue;  // saves time: a regular expression reads slowly
    }
    for (std::sregex_iterator it(line.begin(), line.end(), kLink), end; it != end; ++it) {
      const std::string place = it->str(2);
      if (!std::regex_match(place, kElsewhere)) {
        const path target = place.empty() ? page : page.parent_path() / place;
        links.push_back({it->str(1), target.lexically_normal(), it->str(4)});
      }
    }
  }
  return links;
}

// As GitHub makes the anchor of a heading: lower case, blanks to hyphens, no other punctuation.
std::string anchor_of(const std::string& heading) {
  static const std::regex kLinked(R"(\[([^\]]*)\]\([^)]*\))");
  std::string anchor;
  for (const char c : std::regex_replace(heading, kLinked, "$1")) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 128 || std::isalnum(byte) != 0 || c == '_' || c == '-') {
      anchor += static_cast<char>(byte < 128 ? std::tolower(byte) : byte);
    } else if (c == ' ') {
      anchor += '-';
    }
  }
  return anchor;
}

std::set<std::string> anchors_of(const path& page) {
  std::set<std::string> anchors;
  std::map<std::string, int> seen;
  bool is_code = false;
  for (const std::string& line : house_test::lines_of(kRoot / page)) {
    is_code = is_code != line.starts_with("```");
    if (const std::size_t level = line.find_first_not_of('#');
        !is_code && level != std::string::npos && level > 0 && line[level] == ' ') {
      const std::string anchor = anchor_of(line.substr(level + 1));
      const int times = seen[anchor]++;
      anchors.insert(times == 0 ? anchor : anchor + "-" + std::to_string(times));
    }
  }
  return anchors;
}

// "härkegård2002" of "Härkegård 2002", without accents; the first author of several.
std::string citation_key(std::string text) {
  static const std::vector<std::pair<std::string, std::string>> kPlain{
      {"ä", "a"}, {"å", "a"}, {"é", "e"}, {"ö", "o"}, {"š", "s"}, {"Š", "s"}, {"ü", "u"}};
  for (const auto& [accented, plain] : kPlain) {
    for (std::size_t at = text.find(accented); at != std::string::npos; at = text.find(accented)) {
      text.replace(at, accented.size(), plain);
    }
  }
  static const std::regex kCitation(R"((.*?)(?: & .*| et al\.)? (\d{4}))");
  std::smatch match;
  if (!std::regex_match(text, match, kCitation)) {
    return text;
  }
  std::string key;
  for (const char c : match.str(1) + match.str(2)) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      key += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  return key;
}

TEST(Docs, LinksResolve) {
  std::map<path, std::set<std::string>> anchors;
  std::size_t seen = 0;
  for (const path& page : all_pages()) {
    for (const Link& link : links_of(page)) {
      ++seen;
      ASSERT_TRUE(exists(kRoot / link.target)) << page << " links to " << link.target;
      if (!link.anchor.empty() && link.target.extension() == ".md") {
        auto [entry, is_new] = anchors.try_emplace(link.target);
        if (is_new) {
          entry->second = anchors_of(link.target);
        }
        EXPECT_TRUE(entry->second.contains(link.anchor))
            << page << " links to " << link.target << "#" << link.anchor;
      }
    }
  }
  EXPECT_GT(seen, 300U) << "links were not recognised";
}

TEST(Docs, PagesAreFewAndNear) {
  const std::vector<path> pages = pages_below("docs");
  EXPECT_LE(pages.size(), kMostPages);
  EXPECT_GT(pages.size(), 10U);
  std::map<path, int> clicks{{"README.md", 0}};
  std::vector<path> queue{"README.md"};
  for (std::size_t i = 0; i < queue.size(); ++i) {
    const path page = queue[i];
    for (const Link& link : links_of(page)) {
      if (link.target.extension() == ".md" && exists(kRoot / link.target) &&
          clicks.try_emplace(link.target, clicks.at(page) + 1).second) {
        queue.push_back(link.target);
      }
    }
  }
  for (const path& page : pages) {
    ASSERT_TRUE(clicks.contains(page)) << page << " is linked from nowhere";
    EXPECT_LE(clicks.at(page), kMostClicks) << page;
  }
}

TEST(Docs, SourcesMentionPagesThatExist) {
  static const std::regex kMention(
      R"((?:docs/)?\b((howto|reference|method|measured)/\w+\.md)|docs/\w+\.md)");
  std::size_t seen = 0;
  for (const path& file : house_test::files_below({"src", "include", "lab", "tests", "examples"})) {
    for (const std::string& line : house_test::lines_of(file)) {
      if (line.find(".md") == std::string::npos) {
        continue;
      }
      for (std::sregex_iterator it(line.begin(), line.end(), kMention), end; it != end; ++it) {
        ++seen;
        EXPECT_TRUE((*it)[1].matched && exists(kRoot / "docs" / it->str(1)))
            << file << " mentions " << it->str();
      }
    }
  }
  EXPECT_GT(seen, 50U) << "mentions were not recognised";
}

TEST(Docs, CitationsAreInTheBibliography) {
  const std::string bibliography = house_test::text_of(kRoot / "docs/bibliography.bib");
  std::size_t seen = 0;
  for (const path& page : all_pages()) {
    for (const Link& link : links_of(page)) {
      if (link.target == "docs/bibliography.bib" &&
          link.text.find_last_of("0123456789") + 1 == link.text.size()) {
        ++seen;
        EXPECT_NE(bibliography.find("{" + citation_key(link.text) + ","), std::string::npos)
            << page << " cites " << link.text;
      }
    }
  }
  EXPECT_GT(seen, 20U) << "citations were not recognised";
}

TEST(Docs, AnchorsAndKeysAreAsMeant) {
  EXPECT_EQ(anchor_of("The table [live.dds]"), "the-table-livedds");
  EXPECT_EQ(anchor_of("`kelpie inspect LOG`"), "kelpie-inspect-log");
  EXPECT_EQ(citation_key("Härkegård 2002"), "harkegard2002");
  EXPECT_EQ(citation_key("Gibbs & Candès 2021"), "gibbs2021");
  EXPECT_EQ(citation_key("Nguyen-Tuong et al. 2009"), "nguyentuong2009");
  EXPECT_EQ(citation_key("von Benzon et al. 2022"), "vonbenzon2022");
}

// A newcomer's first two commands, side by side, before anything else.
TEST(Docs, TheReadmeBeginsWithItsTwoCommands) {
  std::vector<std::string> before;
  for (const std::string& line : lines_of(kRoot / "README.md")) {
    if (line.starts_with("## ")) {
      break;
    }
    before.push_back(line);
  }
  const auto row = [&](const std::string& begin) {
    return std::ranges::find_if(before, [&](const auto& line) { return line.starts_with(begin); });
  };
  const auto run = row("| `./run.sh` |");
  ASSERT_NE(run, before.end());
  EXPECT_EQ(row("| `./test.sh` |"), run + 1);
}

}  // namespace
}  // namespace kelpie::docs_test
