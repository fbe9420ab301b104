// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "jobs/journal.hpp"
#include "study/forward_chain.hpp"

namespace kelpie::study {

/// What was evaluated: settings of one axis on one log's rung.
struct EvaluationKey {
  std::size_t log = 0;   ///< place among the logs
  std::string axis;      ///< target column
  std::size_t rung = 0;  ///< of that log
  std::string settings;  ///< "name=value name=value …", all settings of the axis; or a baseline

  auto operator<=>(const EvaluationKey&) const = default;
  std::string text() const;  ///< One line that no other key has.
};

/// Finished evaluations on disk, so that a search that was stopped goes on where it was: a
/// jobs::Journal, with its checksums, for one process at a time. An evaluation depends on its key
/// and the header alone, so it doesn't matter which run made it, nor which process.
class TuneJournal {
 public:
  /// What evaluations must agree in to be comparable: names and values, in words.
  using Header = jobs::Journal::Header;

  /// Opens the journal, or begins one. Throws what jobs::Journal throws.
  TuneJournal(std::filesystem::path file, const Header& header);

  bool has(const EvaluationKey& key) const { return journal_.has(key.text()); }

  /// Read from disk; nothing when the evaluation is still to be made.
  std::optional<ChainScore> find(const EvaluationKey& key) const;

  /// Requires a key that isn't there yet and a `result` of score_text(). Throws Failure when the
  /// line can't be written.
  void add(const EvaluationKey& key, std::string_view result);

  std::size_t size() const { return journal_.size(); }

 private:
  jobs::Journal journal_;
};

/// An evaluation's result as JSON in one line, from which find() reads it back to the last bit.
std::string score_text(const ChainScore& score);

}  // namespace kelpie::study
