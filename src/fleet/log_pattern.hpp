// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kelpie::fleet {

/// A log that a pattern has found.
struct MatchedLog {
  std::filesystem::path file;  ///< or the folder of a bag
  std::string vehicle;         ///< what stands for {vehicle}; empty where the pattern has none
  std::string mission;         ///< … for {mission}
};

/// Which logs a study is about: a path in which `*`, `?` and `[…]` stand for what they do in a
/// shell, `**` for any number of folders, none included, and {vehicle} and {mission} for a `*` that
/// names the log's group: "dives/{vehicle}/**/{mission}.bag". Files and folders whose names begin
/// with a dot are passed over, as in a shell.
class LogPattern {
 public:
  /// Throws InputError on more than one `**`, a `**` that is only a part of a name, a name in
  /// braces that isn't one of the two or stands beside another wildcard.
  explicit LogPattern(const std::string& text);

  /// What it finds; a pattern that is no absolute path is looked for in `folder`. In no order.
  /// Throws Failure where the file system fails.
  std::vector<MatchedLog> find(const std::filesystem::path& folder) const;

  const std::string& text() const { return text_; }

 private:
  // A part of the path, from one slash to the next.
  struct Part {
    std::string pattern;     // of fnmatch()
    std::string named{};     // "vehicle", "mission" or empty
    std::size_t before = 0;  // letters of the part that stand before what is named
    std::size_t after = 0;
  };

  static Part part_of(const std::string& text);
  std::string joined(std::size_t begin, std::size_t end) const;
  void add(const std::filesystem::path& file, std::size_t folders,
           std::vector<MatchedLog>& found) const;

  std::string text_;
  std::vector<Part> parts_;
  std::size_t any_depth_;  // place of the `**`; parts_.size() where there is none
};

}  // namespace kelpie::fleet
