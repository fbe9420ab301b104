// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "file/out_folder.hpp"

namespace kelpie::cli {

/// Prints text that is safe for a terminal: control characters and broken UTF-8 become U+FFFD. Line
/// ends and tabs stay.
void print_safely(std::FILE* stream, std::string_view text);

/// Output and error stream of a program.
struct Streams {
  std::FILE* out = stdout;
  std::FILE* err = stderr;
};

/// The streams that commands print to; the standard streams where no StreamGuard lives.
const Streams& streams();

/// Commands print to the given streams during the lifetime of the guard, and begin neither
/// hushed nor brief: for programs that run commands. At most one instance at a time, made before
/// other threads.
class StreamGuard {
 public:
  explicit StreamGuard(const Streams& streams);
  ~StreamGuard();
  StreamGuard(const StreamGuard&) = delete;
  StreamGuard& operator=(const StreamGuard&) = delete;
};

/// A stream that keeps its text.
class TextStream {
 public:
  TextStream();
  ~TextStream();
  TextStream(const TextStream&) = delete;
  TextStream& operator=(const TextStream&) = delete;

  std::FILE* file() const { return file_; }
  std::string text() const;

 private:
  char* text_ = nullptr;
  std::size_t size_ = 0;
  std::FILE* file_;
};

/// What say() and warn() call.
void print_said(std::string_view text);
void print_warning(std::string_view text);

/// Switches say() off, or on again.
void hush(bool wanted);

/// Whether tables of the log's signals are left to --verbose.
void be_brief(bool wanted);
bool is_brief();

/// Prints to the output stream, hushed or not.
void print_document(std::string_view text);

/// Prints to the output stream, unless hushed.
template <typename... Values>
void say(fmt::format_string<Values...> format, Values&&... values) {
  print_said(fmt::format(format, std::forward<Values>(values)...));
}

/// Prints to the error stream.
template <typename... Values>
void warn(fmt::format_string<Values...> format, Values&&... values) {
  print_warning(fmt::format(format, std::forward<Values>(values)...));
}

/// Flushes the output stream. Throws Failure where writing failed.
void finish_output();

/// Checks a file that a command will write, named by `option`. Throws InputError on one of the
/// `inputs` (files or bags; "" is skipped), which would be lost, and on a folder, device or pipe;
/// Failure where writing is impossible.
void check_output(std::string_view option, const std::string& file,
                  const std::vector<std::string>& inputs);

/// Locks the --out folder of a long run for the files `names`, after the same check.
file::OutFolder take_out_folder(const std::string& folder, const std::vector<std::string>& names,
                                const std::vector<std::string>& inputs);

}  // namespace kelpie::cli
