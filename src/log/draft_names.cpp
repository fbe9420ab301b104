// SPDX-License-Identifier: Apache-2.0
#include "log/draft_names.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <string_view>

#include "kelpie/core/text.hpp"

namespace kelpie::log {
namespace {

// Names that mean something else to a log.
constexpr std::array<std::string_view, 19> kTaken{
    "t",    "time",          "stamp", "u",   "v",  "w",  "p",  "q",
    "r",    "phi",           "theta", "psi", "qw", "qx", "qy", "qz",
    "conf", "configuration", "split"};

std::vector<std::string> parts_of(const std::string& column) {
  std::vector<std::string> parts(1);
  for (const char c : column) {
    const bool is_of_word = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
    if (is_of_word) {
      parts.back() += c;
    } else if (!parts.back().empty()) {
      parts.emplace_back();
    }
  }
  if (parts.back().empty()) {
    parts.pop_back();
  }
  return parts;
}

bool is_taken(const std::string& name) {
  return name.empty() || std::ranges::find(kTaken, name) != kTaken.end();
}

}  // namespace

std::vector<std::string> short_names(const std::vector<CandidateColumn>& columns) {
  std::vector<std::vector<std::string>> all;
  for (const CandidateColumn& column : columns) {
    all.push_back(parts_of(column.name));
  }
  const auto is_shared = [&](const std::string& part) {
    return std::ranges::all_of(
        all, [&](const auto& parts) { return std::ranges::find(parts, part) != parts.end(); });
  };
  std::set<std::string> used;
  std::vector<std::string> names;
  for (const std::vector<std::string>& parts : all) {
    std::vector<std::string> own;
    std::string shared = "n";  // the last word that all have
    for (const std::string& part : parts) {
      if (!is_shared(part)) {
        own.push_back(part);
      } else if (part != "data" && part != "value") {
        shared = part;
      }
    }
    std::string name = own.empty() ? shared : join_text(own, "_");
    const bool is_number = std::isdigit(static_cast<unsigned char>(name.front())) != 0;
    if (is_number || is_taken(name)) {
      name = (shared == name ? "n" : shared) + (is_number ? "" : "_") + name;
    }
    const std::string stem = name;
    for (int k = 2; is_taken(name) || !used.insert(name).second; ++k) {
      name = stem + "_" + std::to_string(k);
    }
    names.push_back(name);
  }
  return names;
}

}  // namespace kelpie::log
