// SPDX-License-Identifier: Apache-2.0
#include "fleet/log_pattern.hpp"

#include <fnmatch.h>
#include <glob.h>

#include <algorithm>
#include <iterator>
#include <regex>
#include <string_view>
#include <system_error>

#include "kelpie/core/error.hpp"

namespace kelpie::fleet {
namespace {

namespace fs = std::filesystem;

constexpr const char* kAnyDepth = "**";
constexpr std::string_view kWildcards = "*?[";

// A path as a pattern that nothing else fits.
std::string literal(const std::string& path) {
  std::string text;
  for (const char letter : path) {
    if ((std::string(kWildcards) + "]\\").find(letter) != std::string::npos) {
      text += '\\';
    }
    text += letter;
  }
  return text;
}

// A part of a name with * and ? as a regular expression.
std::string regex_of(const std::string& text) {
  std::string expression;
  for (const char letter : text) {
    if (letter == '*') {
      expression += ".*?";
    } else if (letter == '?') {
      expression += '.';
    } else {
      const bool is_special = std::string_view(R"(^$\.+()[]{}|)").find(letter) != std::string::npos;
      expression += (is_special ? "\\" : "") + std::string(1, letter);
    }
  }
  return expression;
}

std::vector<fs::path> globbed(const std::string& pattern) {
  glob_t found = {};
  // NOLINTNEXTLINE(concurrency-mt-unsafe): patterns are read before threads start
  const int result = ::glob(pattern.c_str(), GLOB_NOSORT, nullptr, &found);
  std::vector<fs::path> paths(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  ::globfree(&found);
  if (result != 0 && result != GLOB_NOMATCH) {
    throw Failure(pattern + ": the folders can't be searched");
  }
  return paths;
}

std::vector<std::string> parts_of_path(const fs::path& path) {
  std::vector<std::string> parts;
  std::ranges::transform(path, std::back_inserter(parts),
                         [](const fs::path& part) { return part.string(); });
  return parts;
}

}  // namespace

LogPattern::LogPattern(const std::string& text) : text_(text) {
  std::string path = text;
  path.erase(path.find_last_not_of('/') + 1);
  require(!path.empty(), "", "has to be a path, with or without wildcards");
  for (const std::string& part : parts_of_path(path)) {
    parts_.push_back(part_of(part));
  }
  const auto is_any = [](const Part& part) { return part.pattern == kAnyDepth; };
  any_depth_ = static_cast<std::size_t>(std::ranges::find_if(parts_, is_any) - parts_.begin());
  require(std::ranges::count_if(parts_, is_any) <= 1 && (parts_.empty() || !is_any(parts_.back())),
          "", "'" + text + "' may have one ** at most, with a name after it, as in \"**/*.csv\"");
}

LogPattern::Part LogPattern::part_of(const std::string& text) {
  const std::size_t open = text.find('{');
  if (open == std::string::npos) {
    require(text == kAnyDepth || text.find(kAnyDepth) == std::string::npos, "",
            "in '" + text + "' ** has to stand between slashes, alone");
    return {.pattern = text};
  }
  Part part;
  std::string groups;
  std::size_t at = 0;
  for (std::size_t next = open; next != std::string::npos; next = text.find('{', at)) {
    const std::size_t close = text.find('}', next);
    require(close != std::string::npos, "", "in '" + text + "' a { has no }");
    const std::string named = text.substr(next + 1, close - next - 1);
    require(named == "vehicle" || named == "mission", "",
            "in '" + text + "' {" + named + "} has to be {vehicle} or {mission}");
    require(std::ranges::count(part.named, named) == 0, "",
            "in '" + text + "' {" + named + "} stands twice");
    const auto is_open = [&](std::size_t place) {
      return place < text.size() && std::string_view("*?{}").find(text[place]) != std::string::npos;
    };
    require(!is_open(next - 1) && !is_open(close + 1), "",
            "in '" + text + "' no other wildcard may stand beside {" + named +
                "} without letters between");
    const std::string before = text.substr(at, next - at);
    part.pattern += before + "*";
    groups += regex_of(before) + "(.*?)";
    part.named.push_back(named);
    at = close + 1;
  }
  const std::string after = text.substr(at);
  require(text.find_first_of("[\\") == std::string::npos && after.find('}') == std::string::npos,
          "", "in '" + text + "' no [ and \\ may stand beside {" + part.named.front() + "}");
  part.pattern += after;
  part.groups = std::regex(groups + regex_of(after));
  return part;
}

std::string LogPattern::joined(std::size_t begin, std::size_t end) const {
  fs::path path;
  for (std::size_t i = begin; i < end; ++i) {
    path /= parts_[i].pattern;
  }
  return path.string();
}

// `folders`: how many names of the path stand before those of the pattern.
void LogPattern::add(const fs::path& file, std::size_t folders,
                     std::vector<MatchedLog>& found) const {
  MatchedLog log{.file = file, .vehicle = {}, .mission = {}};
  const std::vector<std::string> names = parts_of_path(file);
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Part& part = parts_[i];
    if (part.named.empty()) {
      continue;
    }
    const std::string& name =
        i < any_depth_ ? names[folders + i] : names[names.size() - (parts_.size() - i)];
    std::smatch found_groups;
    if (std::regex_match(name, found_groups, part.groups)) {
      for (std::size_t k = 0; k < part.named.size(); ++k) {
        (part.named[k] == "vehicle" ? log.vehicle : log.mission) = found_groups[k + 1].str();
      }
    }
  }
  found.push_back(std::move(log));
}

std::vector<MatchedLog> LogPattern::find(const fs::path& folder) const {
  const bool absolute = fs::path(text_).is_absolute();
  const std::size_t folders = absolute ? 0 : parts_of_path(folder).size();
  const std::string base = absolute ? "" : literal((folder / "").string());
  std::vector<MatchedLog> found;
  const std::vector<fs::path> heads =
      any_depth_ == 0 ? std::vector{folder} : globbed(base + joined(0, any_depth_));
  if (any_depth_ == parts_.size()) {
    for (const fs::path& file : heads) {
      add(file, folders, found);
    }
    return found;
  }
  const std::string tail = joined(any_depth_ + 1, parts_.size());
  const std::size_t depth = parts_.size() - any_depth_ - 1;
  for (const fs::path& head : heads) {
    std::error_code error;
    if (!fs::is_directory(head, error)) {
      continue;
    }
    const std::size_t above = parts_of_path(head).size();
    fs::recursive_directory_iterator at(head, fs::directory_options::skip_permission_denied, error);
    for (; !error && at != fs::recursive_directory_iterator(); at.increment(error)) {
      if (at->path().filename().string().starts_with('.')) {
        at.disable_recursion_pending();
        continue;
      }
      const std::vector<std::string> names = parts_of_path(at->path());
      if (names.size() < above + depth) {
        continue;
      }
      fs::path last;
      for (std::size_t i = names.size() - depth; i < names.size(); ++i) {
        last /= names[i];
      }
      if (::fnmatch(tail.c_str(), last.c_str(), FNM_PATHNAME | FNM_PERIOD) == 0) {
        add(at->path(), folders, found);
      }
    }
    if (error) {
      throw Failure(head.string() + ": cannot be searched: " + error.message());
    }
  }
  return found;
}

}  // namespace kelpie::fleet
