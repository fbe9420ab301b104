// SPDX-License-Identifier: Apache-2.0
// Floors of shape: functions that fit a screen, classes that fit a mind.

#include <gtest/gtest.h>

#include <cctype>
#include <cstddef>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

#include "house/sources.hpp"

namespace kelpie::shape_test {
namespace {

constexpr std::size_t kMostLines = 60;
constexpr int kMostMembers = 20;

struct Function {
  std::string signature;
  std::size_t line = 0;
  std::size_t lines = 0;
};

// Functions as clang-format lays them out: a signature ends with "{", and the body with "}" in the
// column where the signature begins. Tables of constants count no less.
std::vector<Function> functions_in(const std::vector<std::string>& lines) {
  static const std::regex kSignature(R"((  )?[^\s/#}].*\{)");
  static const std::regex kOther(R"(\s*(namespace|class|struct|enum|union|extern)\b.*)");
  std::vector<Function> functions;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!std::regex_match(lines[i], kSignature) || std::regex_match(lines[i], kOther) ||
        lines[i].find('(') == std::string::npos) {
      continue;
    }
    const std::string end = std::string(lines[i].find_first_not_of(' '), ' ') + "}";
    const std::size_t first = i;
    while (i + 1 < lines.size() && !lines[i].starts_with(end)) {
      ++i;
    }
    functions.push_back({lines[first], first + 1, i - first + 1});
  }
  return functions;
}

TEST(Shape, AFunctionFitsAScreen) {
  std::size_t seen = 0;
  for (const auto& file : house_test::files_below({"src", "include", "lab"})) {
    for (const Function& function : functions_in(house_test::lines_of(file))) {
      ++seen;
      const bool is_table = function.signature.find("= std::to_array") != std::string::npos;
      EXPECT_TRUE(is_table || function.lines <= kMostLines)
          << file << ":" << function.line << ": " << function.lines << " lines";
    }
  }
  EXPECT_GT(seen, 2000U) << "functions were not recognised";
}

// Counts the public members of the class with the name and body: functions and data, without
// constructors, destructor, assignments, types, friends, and deleted or defaulted functions.
class MemberCount {
 public:
  MemberCount(const std::string& name, std::string_view body)
      : special_("(explicit )?~?" + name + R"(\s*[()].*|.*\boperator=.*)") {
    for (std::size_t i = 0, depth = 1, round = 0; depth > 0 && i < body.size(); ++i) {
      const char c = body[i];
      depth += c == '{' ? 1 : 0;
      depth -= c == '}' ? 1 : 0;
      round += c == '(' ? 1 : 0;
      round -= c == ')' ? 1 : 0;
      if (depth != 1 || round != 0) {
        continue;
      }
      const bool body_ends = c == '}' && next_mark(body, i + 1) != ';' &&
                             next_mark(body, i + 1) != ',' && next_mark(body, i + 1) != '{';
      if (c == ';' || body_ends) {
        finish();
      } else if (c == ':' && is_access()) {
        is_public_ = text_.ends_with("public");
        text_.clear();
      } else if (!is_space(c) || !text_.empty()) {
        text_ += is_space(c) ? ' ' : c;
      }
    }
  }

  int count() const { return count_; }

 private:
  static bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }
  static char next_mark(std::string_view body, std::size_t i) {
    while (i < body.size() && is_space(body[i])) {
      ++i;
    }
    return i < body.size() ? body[i] : '\0';
  }
  bool is_access() const { return text_ == "public" || text_ == "private" || text_ == "protected"; }
  void finish() {
    static const std::regex kNone(
        R"((using|friend|struct|class|enum)\b.*|.*=\s*(delete|default)\s*|\s*)");
    const bool counts =
        is_public_ && !std::regex_match(text_, kNone) && !std::regex_match(text_, special_);
    count_ += counts ? 1 : 0;
    text_.clear();
  }

  std::regex special_;
  bool is_public_ = false;
  int count_ = 0;
  std::string text_;
};

TEST(Shape, AClassHasAtMostTwentyPublicMembers) {
  static const std::regex kClass(R"(\bclass\s+(\w+)(\s+final)?\s*(:[^{;:][^{;]*)?\{)");
  const auto here = std::regex_constants::match_continuous | std::regex_constants::match_prev_avail;
  std::size_t seen = 0;
  for (const auto& file : house_test::files_below({"src", "include", "lab"})) {
    const std::string code = " " + house_test::code_of(file);
    // The expression alone, tried on every character, takes a hundred times as long.
    for (std::size_t at = code.find("class"); at != std::string::npos;
         at = code.find("class", at + 1)) {
      std::smatch match;
      if (!std::regex_search(code.begin() + static_cast<std::ptrdiff_t>(at), code.end(), match,
                             kClass, here)) {
        continue;
      }
      ++seen;
      const std::size_t body = at + static_cast<std::size_t>(match.length());
      EXPECT_LE(MemberCount(match[1], std::string_view(code).substr(body)).count(), kMostMembers)
          << match[1] << " in " << file;
    }
  }
  EXPECT_GT(seen, 200U) << "classes were not recognised";
}

TEST(Shape, MembersAreCounted) {
  const std::string body = R"( public: A() = default; explicit A(int x) : x_(x), y_{x} {}
    int x() const { return x_; } void f(int a = 1, int b = 2); using B = int; struct C { int d; };
    A& operator=(A&&) noexcept; ~A(); int data = 0; private: int x_; };)";
  EXPECT_EQ(MemberCount("A", body).count(), 3);
}

}  // namespace
}  // namespace kelpie::shape_test
