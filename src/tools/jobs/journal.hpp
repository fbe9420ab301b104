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

/// Names and values common to the results of a journal.
using JournalHeader = std::vector<std::pair<std::string, std::string>>;

/// A journal of any process, opened for reading. The file has JSON lines, each with a checksum of
/// the rest of the line: first a header, then a line per result. Broken lines at the end, as left
/// by a killed process or a lost machine, are ignored. Of several lines with the same key the last
/// counts.
///
/// Results stay on disk: a line costs some 100 bytes of memory.
class JournalReader {
 public:
  using Header = JournalHeader;

  /// Throws InputError if the file cannot be read, is no journal of `kind`, has a broken line
  /// between good lines, or has a different header (the message names the difference).
  JournalReader(std::filesystem::path file, std::string_view kind, const Header& header);

  bool has(const std::string& key) const;
  /// Reads the result of a key from disk. Requires has(key). Throws Failure if the line cannot be
  /// read.
  std::string result(const std::string& key) const;

  std::size_t size() const { return places_.size(); }  ///< number of keys
  const std::filesystem::path& file() const { return file_; }

 protected:
  /// A line's place in the file.
  struct Line {
    std::uint64_t begin = 0;
    std::size_t size = 0;  ///< without the line's end
  };

  JournalReader(std::filesystem::path file, int flags);
  std::size_t read(std::string_view kind, const Header& header);
  [[noreturn]] void refuse(std::size_t line, std::string_view field, const std::string& why) const;

  std::filesystem::path file_;
  file::Descriptor descriptor_;
  std::uint64_t size_ = 0;                        ///< bytes of whole lines
  std::unordered_map<std::string, Line> places_;  ///< by key, as JSON

 private:
  void check_header(std::string_view line, std::string_view kind, const Header& header) const;
  std::string key_in(std::string_view line, std::size_t number) const;
};

/// A journal opened for appending by a process, so that stopped work can be resumed. A result has
/// to depend on key and header alone.
///
/// An added result is with the operating system at once: a killed process loses no result. add()
/// writes the file to the disk if the last write is older than kTuning.sync_period, and so does the
/// destructor: a power failure loses the results of the last second, and results without a later
/// add() within half a minute.
class Journal : public JournalReader {
 public:
  /// Opens or begins the journal (folders are made). Broken lines at the end are cut off. Throws
  /// as JournalReader does; InputError if another process has the journal open for appending;
  /// Failure if the file cannot be written.
  Journal(std::filesystem::path file, std::string_view kind, const Header& header);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// Adds a result, or replaces the result of a key. Requires JSON in a single line. Throws Failure
  /// if the line cannot be written (then no part of the line is left) or not be put on the disk.
  void add(const std::string& key, std::string_view result);

 private:
  void take() const;
  Line append(const std::string& line);
  void put_on_disk();

  bool is_on_disk_ = true;
  std::chrono::steady_clock::time_point on_disk_ = std::chrono::steady_clock::now();
};

}  // namespace kelpie::jobs
