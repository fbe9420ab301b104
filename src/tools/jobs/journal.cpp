// SPDX-License-Identifier: Apache-2.0
#include "jobs/journal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <optional>
#include <span>
#include <system_error>

#include "file/atomic_file.hpp"
#include "file/crc32.hpp"
#include "file/json.hpp"
#include "jobs/tuning.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::jobs {
namespace {

using file::Json;

constexpr int kJournalVersion = 1;
constexpr std::string_view kSumBegin = R"({"crc32":")";
constexpr std::string_view kSumEnd = R"(",)";
constexpr std::size_t kSumDigits = 8;

std::string checksum(std::string_view text) {
  return fmt::format("{:08x}", file::crc32_of(std::as_bytes(std::span(text))));
}

// A JSON object in one line, without its first brace, under a checksum of itself.
std::string with_checksum(std::string_view rest) {
  return fmt::format("{}{}{}{}\n", kSumBegin, checksum(rest), kSumEnd, rest);
}

// What is under the checksum, if that is right.
std::optional<std::string_view> under_checksum(std::string_view line) {
  const std::size_t before = kSumBegin.size() + kSumDigits + kSumEnd.size();
  if (line.size() <= before || !line.starts_with(kSumBegin)) {
    return std::nullopt;
  }
  const std::string_view rest = line.substr(before);
  return line.substr(kSumBegin.size(), kSumDigits) == checksum(rest) ? std::optional(rest)
                                                                     : std::nullopt;
}

std::string header_line(std::string_view kind, const JournalHeader& header) {
  return with_checksum(
      file::one_line({{"format", kind}, {"version", kJournalVersion}, {"of", file::object(header)}})
          .substr(1));
}

// Whether a file of a single line without an end can be the beginning of a journal: the part of the
// first line that a killed process has written, or zeros, as a lost machine may leave them.
bool may_have_been_begun(std::string_view line) {
  const std::size_t end = std::min(line.find('\0'), line.size());
  const bool zeros_follow = line.find_first_not_of('\0', end) == std::string_view::npos;
  line = line.substr(0, end);
  return zeros_follow && line.substr(0, kSumBegin.size()) == kSumBegin.substr(0, line.size());
}

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : ".";
}

std::string reason() {
  return std::generic_category().message(errno);
}

}  // namespace

JournalReader::JournalReader(std::filesystem::path file, int flags)
    : file_(std::move(file)), descriptor_(file_, flags) {}

JournalReader::JournalReader(std::filesystem::path file, std::string_view kind,
                             const Header& header)
    : JournalReader(std::move(file), O_RDONLY | O_NONBLOCK) {
  read(kind, header);
}

Journal::Journal(std::filesystem::path file, std::string_view kind, const Header& header)
    : JournalReader((file::make_folder(folder_of(file)), std::move(file)), O_RDWR | O_CREAT) {
  take();
  const std::size_t found = read(kind, header);
  if (size_ < found && ::ftruncate(descriptor_.number(), static_cast<off_t>(size_)) != 0) {
    throw Failure(fmt::format("{}: cannot be written: {}", file_.string(), reason()));
  }
  if (size_ == 0) {
    append(header_line(kind, header));
  }
}

Journal::~Journal() {
  if (!is_on_disk_) {
    ::fdatasync(descriptor_.number());
  }
}

void Journal::take() const {
  if (!descriptor_.is_open()) {
    throw Failure(fmt::format("{}: cannot be written: {}", file_.string(), reason()));
  }
  if (!descriptor_.lock(LOCK_EX | LOCK_NB) && errno == EWOULDBLOCK) {
    refuse(0, "", "another run is writing into this journal; give another --out, or wait");
  }
}

// Returns the file's size.
std::size_t JournalReader::read(std::string_view kind, const Header& header) {
  const bool is_file = std::filesystem::is_regular_file(file_);  // to read a pipe might wait
  std::ifstream stream(is_file ? file_ : "", std::ios::binary);
  if (!stream.is_open()) {
    throw InputError({.file = file_.string()}, "cannot be read; a journal is needed");
  }
  std::size_t broken = 0;  // the first of those since the last good line
  std::size_t number = 0;
  std::size_t begin = 0;
  bool has_begun_only = false;
  for (std::string line; std::getline(stream, line);) {
    const bool is_whole = !stream.eof();
    const auto rest = is_whole ? under_checksum(line) : std::nullopt;
    ++number;
    has_begun_only = number == 1 && !is_whole && may_have_been_begun(line);
    if (rest && broken != 0) {
      refuse(broken, "", "doesn't match its checksum; delete this line to go on");
    } else if (!rest) {
      broken = broken == 0 ? number : broken;
    } else if (number == 1) {
      check_header(line, kind, header);
    } else {
      places_.insert_or_assign(key_in(line, number), Line{begin, line.size()});
    }
    begin += line.size() + (is_whole ? 1 : 0);
    if (broken == 0) {
      size_ = begin;
    }
  }
  if (stream.bad()) {
    throw Failure(file_.string() + ": cannot be read to its end");
  }
  if (broken == 1 && !has_begun_only) {
    check_header("", kind, header);
  }
  return begin;
}

void JournalReader::check_header(std::string_view line, std::string_view kind,
                                 const Header& header) const {
  const Json found = file::json_or_discarded(line);
  const auto has = [&found](const char* name, const Json& wanted) {
    const auto value = found.find(name);
    return value != found.end() && *value == wanted;
  };
  if (!found.is_object() || !has("format", kind) || !has("version", kJournalVersion) ||
      !found.contains("of")) {
    refuse(1, "", fmt::format("is no {} of this version of kelpie; give another --out", kind));
  }
  const Json& of = found.at("of");
  for (const auto& [name, value] : header) {
    const auto other = of.find(name);
    const std::string then = other == of.end() ? "none" : file::one_line(*other);
    if (const std::string now = file::one_line(value); now != then) {
      refuse(1, name,
             fmt::format("this run has {}, but the journal was begun with {}; give another --out, "
                         "or delete the journal to begin anew",
                         now, then));
    }
  }
}

// As it stands there: texts that aren't UTF-8 are repaired in a journal.
std::string JournalReader::key_in(std::string_view line, std::size_t number) const {
  const Json json = file::json_or_discarded(line);
  if (!json.is_object() || !json.contains("key") || !json.contains("result")) {
    refuse(number, "", "is no result; delete this line to go on");
  }
  return file::one_line(json.at("key"));
}

bool JournalReader::has(const std::string& key) const {
  return places_.contains(file::one_line(key));
}

std::string JournalReader::result(const std::string& key) const {
  const Line& line = places_.at(file::one_line(key));
  std::string text(line.size, '\0');
  if (::pread(descriptor_.number(), text.data(), text.size(), static_cast<off_t>(line.begin)) !=
          static_cast<ssize_t>(text.size()) ||
      !under_checksum(text)) {
    throw Failure(file_.string() + ": a result can't be read again");
  }
  return file::one_line(file::parse_json(text, file_.string()).at("result"));
}

void Journal::add(const std::string& key, std::string_view result) {
  std::string name = file::one_line(key);
  const Line line = append(with_checksum(fmt::format(R"("key":{},"result":{}}})", name, result)));
  places_.insert_or_assign(std::move(name), line);
  is_on_disk_ = false;
  if (std::chrono::steady_clock::now() - on_disk_ >= kTuning.sync_period) {
    put_on_disk();
  }
}

void Journal::put_on_disk() {
  if (::fdatasync(descriptor_.number()) != 0) {
    throw Failure(fmt::format("{}: cannot be put on the disk: {}", file_.string(), reason()));
  }
  is_on_disk_ = true;
  on_disk_ = std::chrono::steady_clock::now();
}

JournalReader::Line Journal::append(const std::string& line) {
  const std::size_t begin = size_;
  if (!descriptor_.write(line, begin)) {
    const std::string why = reason();
    [[maybe_unused]] const int ignored =
        ::ftruncate(descriptor_.number(), static_cast<off_t>(begin));
    throw Failure(fmt::format("{}: cannot be written: {}", file_.string(), why));
  }
  size_ += line.size();
  return {begin, line.size() - 1};
}

void JournalReader::refuse(std::size_t line, std::string_view field, const std::string& why) const {
  throw InputError({.file = file_.string(), .line = line, .field = std::string(field)}, why);
}

}  // namespace kelpie::jobs
