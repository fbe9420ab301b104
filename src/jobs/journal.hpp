// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "file/descriptor.hpp"

namespace kelpie::jobs {

/// Results of jobs on disk, so that work that was stopped goes on where it was. JSON lines, each
/// with a checksum of the rest of it: a header first, which says what the results are of, then a
/// line for each result, appended as soon as it is there. A result has to depend on its key and the
/// header alone; then it doesn't matter which run made it.
///
/// What was added is the system's at once, so a process that is killed loses nothing. It is put on
/// the disk at most once a second, by the add() that finds the last time to be longer ago, and at
/// the end: a machine that loses its power loses the results of its last second, and those that no
/// later one came after for as long as the system keeps files in memory (half a minute).
///
/// One process has a journal at a time. Results stay on disk: a line costs some 100 bytes of
/// memory.
class Journal {
 public:
  /// Names and values that results must agree in to belong together, in words.
  using Header = std::vector<std::pair<std::string, std::string>>;

  /// Opens the journal, or begins one (folders are made). Broken lines at its end, as a killed
  /// process or a lost machine leaves them, are dropped. Throws InputError when another process has
  /// it, when the file is no journal of `kind`, has a broken line between good ones, or has another
  /// header (naming what differs and how); Failure when it can't be written.
  Journal(std::filesystem::path file, std::string_view kind, const Header& header);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal(Journal&&) = delete;
  Journal& operator=(const Journal&) = delete;
  Journal& operator=(Journal&&) = delete;

  bool has(const std::string& key) const;
  /// The result of a key as it was added, read from disk. Requires has(key). Throws Failure where
  /// it can't be read.
  std::string result(const std::string& key) const;

  /// Requires a `result` that is JSON in one line, and a key that isn't there yet. Throws Failure
  /// where the line can't be written, and leaves no part of it, or can't be put on the disk.
  void add(const std::string& key, std::string_view result);

  std::size_t size() const { return places_.size(); }
  const std::filesystem::path& file() const { return file_; }

 private:
  /// Where a line stands in the file.
  struct Line {
    std::uint64_t begin = 0;
    std::size_t size = 0;  ///< without the line's end
  };

  void take() const;
  void read(std::string_view kind, const Header& header);
  void check_header(std::string_view line, std::string_view kind, const Header& header) const;
  std::string key_in(std::string_view line, std::size_t number) const;
  Line append(const std::string& line);
  void put_on_disk();
  [[noreturn]] void refuse(std::size_t line, std::string_view field, const std::string& why) const;

  std::filesystem::path file_;
  file::Descriptor descriptor_;
  std::uint64_t size_ = 0;  ///< bytes of whole lines
  bool is_on_disk_ = true;
  std::chrono::steady_clock::time_point on_disk_ = std::chrono::steady_clock::now();
  std::unordered_map<std::string, Line> places_;  ///< by key, as JSON
};

}  // namespace kelpie::jobs
