// SPDX-License-Identifier: Apache-2.0
#include "study/tune_journal.hpp"

#include <limits>
#include <utility>

#include "file/json.hpp"

namespace kelpie::study {
namespace {

using file::Json;

constexpr std::string_view kJournalFormat = "kelpie-tune-journal";

double number_or_nan(const Json& json) {
  return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

}  // namespace

std::string EvaluationKey::text() const {
  return file::one_line({{"log", log}, {"axis", axis}, {"rung", rung}, {"settings", settings}});
}

std::string score_text(const ChainScore& score) {
  return file::one_line({{"score", file::number(score.score)},
                         {"stretches", file::numbers(score.stretches)},
                         {"iterations_per_row", score.iterations_per_row},
                         {"given_up", score.given_up}});
}

TuneJournal::TuneJournal(std::filesystem::path file, const Header& header)
    : journal_(std::move(file), kJournalFormat, header) {}

std::optional<ChainScore> TuneJournal::find(const EvaluationKey& key) const {
  const std::string text = key.text();
  if (!journal_.has(text)) {
    return std::nullopt;
  }
  const Json json = file::parse_json(journal_.result(text), text);
  ChainScore score;
  score.score = number_or_nan(json.at("score"));
  for (const Json& stretch : json.at("stretches")) {
    score.stretches.push_back(number_or_nan(stretch));
  }
  score.iterations_per_row = json.at("iterations_per_row").get<double>();
  score.given_up = json.at("given_up").get<bool>();
  return score;
}

void TuneJournal::add(const EvaluationKey& key, std::string_view result) {
  journal_.add(key.text(), result);
}

}  // namespace kelpie::study
