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

/// Key of an evaluation: settings of one axis on one log's rung.
struct EvaluationKey {
  std::size_t log = 0;   ///< place among the logs
  std::string axis;      ///< target column
  std::size_t rung = 0;  ///< of that log
  std::string settings;  ///< "name=value name=value …", every setting of the axis; or a baseline

  auto operator<=>(const EvaluationKey&) const = default;
  std::string text() const;  ///< One line, unique for the key.
};

/// Finished evaluations on disk, so that a stopped search can be resumed: a jobs::Journal, with
/// checksums, for one process at a time. An evaluation depends on its key and the header only, not
/// on the run or process.
class TuneJournal {
 public:
  /// Conditions of comparable evaluations: names and values, in words.
  using Header = jobs::Journal::Header;

  /// Opens or creates the journal. Throws what jobs::Journal throws.
  TuneJournal(std::filesystem::path file, const Header& header);

  bool has(const EvaluationKey& key) const { return journal_.has(key.text()); }

  /// Reads an evaluation from disk; empty if missing.
  std::optional<ChainScore> find(const EvaluationKey& key) const;

  /// Requires a new key and a `result` of score_text(). Throws Failure where writing fails.
  void add(const EvaluationKey& key, std::string_view result);

  std::size_t size() const { return journal_.size(); }

 private:
  jobs::Journal journal_;
};

/// An evaluation's result as JSON in one line; find() reads the same bits back.
std::string score_text(const ChainScore& score);

}  // namespace kelpie::study
