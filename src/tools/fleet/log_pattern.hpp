// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <regex>
#include <string>
#include <vector>

namespace kelpie::fleet {

/// A log matched by a pattern.
struct MatchedLog {
  std::filesystem::path file;  ///< or the folder of a bag
  std::string vehicle;         ///< text matched by {vehicle}; empty for a pattern without {vehicle}
  std::string mission;         ///< text matched by {mission}, likewise
};

/// Pattern of the paths of logs, such as "dives/{vehicle}/**/{mission}.bag". `*`, `?` and `[…]`
/// match as in a shell, `**` matches any number of folders (also zero); {vehicle} and {mission}
/// match like `*`, as few letters as possible from the left, and name the log's group. Names that
/// begin with a dot are skipped, as in a shell.
class LogPattern {
 public:
  /// Throws InputError on a second `**`, on `**` as a part of a name, on braces with an unknown
  /// name, and on a second brace of the same name.
  explicit LogPattern(const std::string& text);

  /// Matching logs, in no order. A relative pattern is relative to `folder`. Throws Failure on
  /// errors of the file system.
  std::vector<MatchedLog> find(const std::filesystem::path& folder) const;

  const std::string& text() const { return text_; }

 private:
  // A part of the path, from one slash to the next.
  struct Part {
    std::string pattern;               // of fnmatch()
    std::vector<std::string> named{};  // "vehicle", "mission", in their order
    std::regex groups{};               // with a group for each of these
  };

  static Part part_of(const std::string& text);
  std::string joined(std::size_t begin, std::size_t end) const;
  void add(const std::filesystem::path& file, std::size_t folders,
           std::vector<MatchedLog>& found) const;

  std::string text_;
  std::vector<Part> parts_;
  std::size_t any_depth_;  // index of `**` in parts_; parts_.size() without `**`
};

}  // namespace kelpie::fleet
