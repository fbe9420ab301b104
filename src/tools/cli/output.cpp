// SPDX-License-Identifier: Apache-2.0
#include "cli/output.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "chart/wording.hpp"
#include "core/text.hpp"
#include "file/atomic_file.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::cli {
namespace {

namespace fs = std::filesystem;

// Whether two names are of one file, which need not be there yet.
bool is_one_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error)) {
    return true;
  }
  const fs::path whole = fs::weakly_canonical(fs::absolute(a, error), error);
  return !whole.empty() && whole == fs::weakly_canonical(fs::absolute(b, error), error);
}

// A bag is a file, or a folder with all the files that bags are made of.
bool is_of_input(const fs::path& file, const fs::path& input) {
  std::error_code error;
  if (!fs::is_directory(input, error)) {
    return is_one_file(file, input);
  }
  const std::string kind = file.extension().string();
  const bool is_of_bag = kind == ".db3" || kind == ".mcap" || kind == ".yaml";
  const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
  return is_of_bag && fs::exists(file, error) && fs::equivalent(folder, input, error);
}

void refuse_inputs(std::string_view option, const fs::path& file,
                   const std::vector<std::string>& inputs) {
  for (const std::string& input : inputs) {
    if (!input.empty() && is_of_input(file, input)) {
      throw InputError({.file = file.string(), .line = 0, .field = std::string(option)},
                       "would overwrite an input; choose another name");
    }
  }
}

// A renamed file would replace a device or a pipe.
void refuse_special(std::string_view option, const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw InputError({.file = file.string(), .line = 0, .field = std::string(option)},
                     fs::is_directory(status)
                         ? "is a folder; the name of a file to write is needed"
                         : "is no regular file; the name of a file to write is needed");
  }
}

struct Printing {
  Streams streams;
  bool hushed = false;
  bool brief = false;
};
Printing printing;

}  // namespace

const Streams& streams() {
  return printing.streams;
}

StreamGuard::StreamGuard(const Streams& streams) {
  printing = {.streams = streams};
}

StreamGuard::~StreamGuard() {
  printing = {};
}

TextStream::TextStream() : file_(::open_memstream(&text_, &size_)) {}

TextStream::~TextStream() {
  static_cast<void>(std::fclose(file_));
  std::free(text_);  // NOLINT: as open_memstream wants it
}

std::string TextStream::text() const {
  static_cast<void>(std::fflush(file_));
  return {text_, size_};
}

void hush(bool wanted) {
  printing.hushed = wanted;
}

void be_brief(bool wanted) {
  printing.brief = wanted;
}

bool is_brief() {
  return printing.brief;
}

void print_document(std::string_view text) {
  print_safely(printing.streams.out, text);
}

void print_safely(std::FILE* stream, std::string_view text) {
  std::string safe;
  while (!text.empty()) {
    const std::size_t length = std::min(text.find_first_of("\n\t"), text.size());
    safe += chart::safe_text(text.substr(0, length));
    safe += text.substr(length, 1);
    text.remove_prefix(std::min(length + 1, text.size()));
  }
  static_cast<void>(std::fwrite(safe.data(), 1, safe.size(), stream));  // finish_output() looks
}

void print_said(std::string_view text) {
  if (!printing.hushed) {
    print_document(text);
  }
}

void print_warning(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = std::min(text.find('\n'), text.size());
    print_safely(printing.streams.err,
                 shortened(text.substr(0, length)) + std::string(text.substr(length, 1)));
    text.remove_prefix(std::min(length + 1, text.size()));
  }
}

void finish_output() {
  errno = 0;
  std::FILE* const out = printing.streams.out;
  if (std::fflush(out) != 0 || std::ferror(out) != 0) {
    const std::string reason = errno == 0 ? "" : ": " + std::generic_category().message(errno);
    throw Failure("standard output: cannot be written" + reason);
  }
}

void check_output(std::string_view option, const std::string& file,
                  const std::vector<std::string>& inputs) {
  refuse_inputs(option, file, inputs);
  refuse_special(option, file);
  file::check_writable(file);
}

file::OutFolder take_out_folder(const std::string& folder, const std::vector<std::string>& names,
                                const std::vector<std::string>& inputs) {
  for (const std::string& name : names) {
    refuse_inputs("--out", fs::path(folder) / name, inputs);
  }
  return {folder, names};
}

}  // namespace kelpie::cli
