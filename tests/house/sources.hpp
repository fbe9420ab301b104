// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

namespace kelpie::house_test {

namespace fs = std::filesystem;

inline const fs::path kRoot = KELPIE_SOURCE_DIR;

/// All headers and sources below `folders`, which are relative to the root of the tree, by name.
inline std::vector<fs::path> files_below(const std::vector<fs::path>& folders) {
  std::vector<fs::path> files;
  for (const fs::path& folder : folders) {
    if (fs::exists(kRoot / folder)) {
      for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder)) {
        const std::string kind = entry.path().extension();
        if (kind == ".hpp" || kind == ".cpp" || kind == ".h") {
          files.push_back(entry.path());
        }
      }
    }
  }
  std::ranges::sort(files);
  return files;
}

inline std::vector<std::string> lines_of(const fs::path& file) {
  std::ifstream stream(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

inline std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The text without comments, preprocessor lines, and the contents of strings and characters.
inline std::string code_of(const fs::path& file) {
  static const std::regex kNotCode(
      R"(//[^\n]*|/\*[^]*?\*/|"(\\.|[^"\\\n])*"|'(\\.|[^'\\\n])'|\n[ \t]*#[^\n]*)");
  return std::regex_replace(text_of(file), kNotCode, " ");
}

}  // namespace kelpie::house_test
