// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

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

/// What say() and warn() print while this object lives, in the order of printing, kept instead of
/// printed: for programs that run commands. At most one instance at a time, before other threads.
class KeptOutput {
 public:
  KeptOutput();
  ~KeptOutput();
  KeptOutput(const KeptOutput&) = delete;
  KeptOutput& operator=(const KeptOutput&) = delete;

  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// print_safely(), unless be_silent() was called or a KeptOutput lives.
void print_unless_silent(std::FILE* stream, std::string_view text);

/// Switches say() and warn() off, for a process that only helps another process; errors are still
/// printed.
void be_silent();

/// Switches say() off, or on again.
void hush(bool wanted);

/// Whether tables of the log's signals are left to --verbose.
void be_brief(bool wanted);
bool is_brief();

/// Prints to the standard output stream, hushed or not, but not after be_silent(); a KeptOutput
/// keeps the text.
void print_document(std::string_view text);

/// Prints to the standard output stream.
template <typename... Values>
void say(fmt::format_string<Values...> format, Values&&... values) {
  print_unless_silent(stdout, fmt::format(format, std::forward<Values>(values)...));
}

/// Prints to the standard error stream.
template <typename... Values>
void warn(fmt::format_string<Values...> format, Values&&... values) {
  print_unless_silent(stderr, fmt::format(format, std::forward<Values>(values)...));
}

/// Flushes the standard output stream. Throws Failure where writing failed.
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
