// SPDX-License-Identifier: Apache-2.0
#include "study/tune_journal.hpp"

#include <limits>
#include <string_view>

#include "file/atomic_file.hpp"
#include "file/json.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::study {
namespace {

using file::Json;
using file::number;

constexpr std::string_view kJournalFormat = "kelpie-tune-journal";
constexpr int kJournalVersion = 1;

double number_or_nan(const Json& json) {
  return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

std::string header_line(const TuneJournal::Header& header) {
  Json json = {{"format", kJournalFormat}, {"version", kJournalVersion}};
  for (const auto& [name, value] : header) {
    json[name] = value;
  }
  return file::json_text(json, -1);
}

std::string evaluation_line(const EvaluationKey& key, const ChainScore& score) {
  return file::json_text({{"axis", key.axis},
                          {"rung", key.rung},
                          {"settings", key.settings},
                          {"score", number(score.score)},
                          {"stretches", file::numbers(score.stretches)},
                          {"iterations_per_row", score.iterations_per_row},
                          {"given_up", score.given_up}},
                         -1);
}

std::pair<EvaluationKey, ChainScore> evaluation(const Json& json) {
  ChainScore score;
  score.score = number_or_nan(json.at("score"));
  for (const Json& stretch : json.at("stretches")) {
    score.stretches.push_back(number_or_nan(stretch));
  }
  score.iterations_per_row = json.at("iterations_per_row").get<double>();
  score.given_up = json.at("given_up").get<bool>();
  return {{json.at("axis").get<std::string>(), json.at("rung").get<std::size_t>(),
           json.at("settings").get<std::string>()},
          score};
}

[[noreturn]] void refuse(const std::filesystem::path& file, std::size_t line,
                         const std::string& field, const std::string& message) {
  throw InputError({.file = file.string(), .line = line, .field = field}, message);
}

void check_header(const std::filesystem::path& file, std::string_view line,
                  const TuneJournal::Header& header) {
  const Json found = Json::parse(line, nullptr, false);
  if (!found.is_object() || found.value("format", "") != kJournalFormat) {
    refuse(file, 1, "", "is no journal of `kelpie tune`; give another --out");
  }
  const Json wanted = Json::parse(header_line(header));
  for (const auto& [name, value] : wanted.items()) {
    const auto other = found.find(name);
    if (other == found.end() || *other != value) {
      refuse(file, 1, name,
             "this search has " + value.dump() + ", but the journal was begun with " +
                 (other == found.end() ? "none" : other->dump()) +
                 "; give another --out, or delete the journal to begin anew");
    }
  }
}

}  // namespace

TuneJournal::TuneJournal(std::filesystem::path file, const Header& header)
    : file_(std::move(file)) {
  const bool resumed = std::filesystem::exists(file_);
  // Rewritten whole, so that what is appended never follows half a line.
  file::write_files_whole(file_.parent_path(), {{file_.filename().string(),
                                                 resumed ? read(header) : header_line(header)}});
  stream_.open(file_, std::ios::binary | std::ios::app);
}

// The content up to the last whole line.
std::string TuneJournal::read(const Header& header) {
  std::string content = file::read_text(file_, "a journal of `kelpie tune`");
  content.erase(content.rfind('\n') + 1);
  std::size_t number = 0;
  for (std::size_t begin = 0; begin < content.size();) {
    const std::size_t end = content.find('\n', begin);
    const std::string_view line = std::string_view(content).substr(begin, end - begin);
    if (++number == 1) {
      check_header(file_, line, header);
    } else {
      try {
        scores_.insert(evaluation(Json::parse(line)));
      } catch (const Json::exception&) {
        refuse(file_, number, "", "is no evaluation of a search; delete this line to go on");
      }
    }
    begin = end + 1;
  }
  if (number == 0) {
    check_header(file_, "", header);
  }
  return content;
}

std::optional<ChainScore> TuneJournal::find(const EvaluationKey& key) const {
  const auto found = scores_.find(key);
  return found == scores_.end() ? std::nullopt : std::optional(found->second);
}

void TuneJournal::add(const EvaluationKey& key, const ChainScore& score) {
  stream_ << evaluation_line(key, score) << std::flush;
  if (!stream_) {
    throw Failure(file_.string() + ": cannot be written");
  }
  scores_.emplace(key, score);
}

}  // namespace kelpie::study
