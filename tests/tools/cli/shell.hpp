// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <regex>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "support.hpp"

namespace kelpie::testing {

/// A script of bash, run in `folder`: what it prints, behind "failed: " where any part of it fails.
inline std::string shell(const TemporaryFolder& folder, const std::string& script) {
  write_text(folder / "script", "set -o pipefail\n" + script);
  const std::string command =
      "cd '" + folder.path().string() + "' && bash script >out 2>&1 </dev/null";
  const int status = std::system(command.c_str());  // NOLINT: the tests' own words
  return (WIFEXITED(status) && WEXITSTATUS(status) == 0 ? "" : "failed: ") +
         content_of(folder / "out");
}

inline bool have(const TemporaryFolder& folder, const std::string& program) {
  return shell(folder, "command -v " + program + " >/dev/null").empty();
}

/// What the first group of `pattern` matches in `text`, again and again.
inline std::vector<std::string> matches(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  std::vector<std::string> found;
  for (std::sregex_iterator it(text.begin(), text.end(), regex), end; it != end; ++it) {
    found.push_back((*it)[1]);
  }
  return found;
}

}  // namespace kelpie::testing
