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

/// Prints to a stream what a terminal can show: control characters, which it would obey, and broken
/// UTF-8 become U+FFFD. Line ends and tabs stay.
void print_safely(std::FILE* stream, std::string_view text);

/// The same, but for a process that is silent.
void print_unless_silent(std::FILE* stream, std::string_view text);

/// From now on say() and warn() say nothing, for a process that only helps another one; errors are
/// still told.
void be_silent();

/// On the standard output stream.
template <typename... Values>
void say(fmt::format_string<Values...> format, Values&&... values) {
  print_unless_silent(stdout, fmt::format(format, std::forward<Values>(values)...));
}

/// On the standard error stream.
template <typename... Values>
void warn(fmt::format_string<Values...> format, Values&&... values) {
  print_unless_silent(stderr, fmt::format(format, std::forward<Values>(values)...));
}

/// Throws Failure where what was printed to the standard output stream can't be written.
void finish_output();

/// For a file that a command is about to write, named by `option`. Throws InputError where it is
/// one of the `inputs` (files, bags, or "" for none), which would be lost, and Failure where it
/// can't be written.
void check_output(std::string_view option, const std::string& file,
                  const std::vector<std::string>& inputs);

/// The same for the files that a long run writes into its --out folder, which it takes.
file::OutFolder take_out_folder(const std::string& folder, const std::vector<std::string>& names,
                                const std::vector<std::string>& inputs);

}  // namespace kelpie::cli
