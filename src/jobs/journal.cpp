// SPDX-License-Identifier: Apache-2.0
#include "jobs/journal.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <optional>
#include <span>
#include <system_error>

#include "file/atomic_file.hpp"
#include "file/crc32.hpp"
#include "file/json.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::jobs {
namespace {

using file::Json;

constexpr int kJournalVersion = 1;
constexpr std::string_view kSumBegin = R"({"crc32":")";
constexpr std::string_view kSumEnd = R"(",)";
constexpr std::size_t kSumDigits = 8;
constexpr std::chrono::seconds kOnDiskEvery{1};

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

std::string header_line(std::string_view kind, const Journal::Header& header) {
  const Json json = {{"format", kind}, {"version", kJournalVersion}, {"of", file::object(header)}};
  return with_checksum(
      std::string_view(json.dump(-1, ' ', false, Json::error_handler_t::replace)).substr(1));
}

std::string reason() {
  return std::generic_category().message(errno);
}

}  // namespace

Journal::Journal(std::filesystem::path file, std::string_view kind, const Header& header)
    : file_((file::make_folder(file.parent_path()), std::move(file))),
      descriptor_(file_, O_RDWR | O_CREAT) {
  take();
  read(kind, header);
  if (size_ == 0) {
    append(header_line(kind, header));
  }
}

Journal::~Journal() {
  ::fdatasync(descriptor_.number());
}

void Journal::take() const {
  if (!descriptor_.is_open()) {
    throw Failure(fmt::format("{}: cannot be written: {}", file_.string(), reason()));
  }
  if (!descriptor_.lock(LOCK_EX | LOCK_NB) && errno == EWOULDBLOCK) {
    refuse(0, "", "another run is writing into this journal; give another --out, or wait");
  }
}

void Journal::read(std::string_view kind, const Header& header) {
  const std::string content = file::read_text(file_, "a journal");
  std::size_t broken = 0;  // the first of those since the last good line
  std::size_t number = 0;
  for (std::size_t begin = 0; begin < content.size();) {
    const std::size_t end = std::min(content.find('\n', begin), content.size());
    const std::string_view line = std::string_view(content).substr(begin, end - begin);
    const auto rest = end < content.size() ? under_checksum(line) : std::nullopt;
    ++number;
    if (rest && broken != 0) {
      refuse(broken, "", "doesn't match its checksum; delete this line to go on");
    } else if (!rest) {
      broken = broken == 0 ? number : broken;
    } else if (number == 1) {
      check_header(line, kind, header);
    } else {
      const Json json = Json::parse(line);
      places_.try_emplace(json.at("key").get<std::string>(), Line{begin, line.size()});
    }
    begin = end + 1;
    if (broken == 0) {
      size_ = begin;
    }
  }
  if (broken == 1 && content.find('\n') != std::string::npos) {
    check_header("", kind, header);
  }
  if (size_ < content.size() && ::ftruncate(descriptor_.number(), static_cast<off_t>(size_)) != 0) {
    throw Failure(fmt::format("{}: cannot be written: {}", file_.string(), reason()));
  }
}

void Journal::check_header(std::string_view line, std::string_view kind,
                           const Header& header) const {
  const Json found = Json::parse(line, nullptr, false);
  if (!found.is_object() || found.value("format", "") != kind ||
      found.value("version", 0) != kJournalVersion || !found.contains("of")) {
    refuse(1, "", fmt::format("is no {} of this version of kelpie; give another --out", kind));
  }
  const Json& of = found.at("of");
  for (const auto& [name, value] : header) {
    const auto other = of.find(name);
    if (other == of.end() || *other != value) {
      refuse(1, name,
             fmt::format("this run has {}, but the journal was begun with {}; give another --out, "
                         "or delete the journal to begin anew",
                         Json(value).dump(), other == of.end() ? "none" : other->dump()));
    }
  }
}

std::string Journal::result(const std::string& key) const {
  const Line& line = places_.at(key);
  std::string text(line.size, '\0');
  if (::pread(descriptor_.number(), text.data(), text.size(), static_cast<off_t>(line.begin)) !=
          static_cast<ssize_t>(text.size()) ||
      !under_checksum(text)) {
    throw Failure(file_.string() + ": a result can't be read again");
  }
  return file::json_text(Json::parse(text).at("result"), -1);
}

void Journal::add(const std::string& key, std::string_view result) {
  places_.emplace(
      key,
      append(with_checksum(fmt::format(R"("key":{},"result":{}}})", Json(key).dump(), result))));
  if (std::chrono::steady_clock::now() - on_disk_ >= kOnDiskEvery) {
    put_on_disk();
  }
}

void Journal::put_on_disk() {
  if (::fdatasync(descriptor_.number()) != 0) {
    throw Failure(fmt::format("{}: cannot be put on the disk: {}", file_.string(), reason()));
  }
  on_disk_ = std::chrono::steady_clock::now();
}

Journal::Line Journal::append(const std::string& line) {
  const auto begin = static_cast<off_t>(size_);
  if (::pwrite(descriptor_.number(), line.data(), line.size(), begin) !=
      static_cast<ssize_t>(line.size())) {
    const std::string why = reason();
    [[maybe_unused]] const int ignored = ::ftruncate(descriptor_.number(), begin);
    throw Failure(fmt::format("{}: cannot be written: {}", file_.string(), why));
  }
  size_ += line.size();
  return {static_cast<std::uint64_t>(begin), line.size() - 1};
}

void Journal::refuse(std::size_t line, std::string_view field, const std::string& why) const {
  throw InputError({.file = file_.string(), .line = line, .field = std::string(field)}, why);
}

}  // namespace kelpie::jobs
