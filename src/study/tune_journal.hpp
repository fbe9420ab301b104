// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "study/forward_chain.hpp"

namespace kelpie::study {

/// What was evaluated: one axis' settings on one rung.
struct EvaluationKey {
  std::string axis;  ///< target column
  std::size_t rung = 0;
  std::string settings;  ///< "name=value name=value …", all settings of the axis

  auto operator<=>(const EvaluationKey&) const = default;
};

/// Finished evaluations on disk, so that a search that was stopped goes on where it was: JSON
/// lines, a header first, then one line for each evaluation, appended as soon as it is finished.
/// An evaluation depends on its key and the header alone, so it doesn't matter which run made it.
class TuneJournal {
 public:
  /// What evaluations must agree in to be comparable: names and values, in words.
  using Header = std::vector<std::pair<std::string, std::string>>;

  /// Opens the journal, or begins one (folders are made). A last line that was cut off is dropped.
  /// Throws InputError when the file is no journal, has a broken line elsewhere, or has another
  /// header (naming what differs and how); Failure when it can't be written.
  TuneJournal(std::filesystem::path file, const Header& header);

  /// Nothing when the evaluation is still to be made.
  std::optional<ChainScore> find(const EvaluationKey& key) const;

  /// Throws Failure when the line can't be written.
  void add(const EvaluationKey& key, const ChainScore& score);

  std::size_t size() const { return scores_.size(); }

 private:
  std::string read(const Header& header);

  std::filesystem::path file_;
  std::map<EvaluationKey, ChainScore> scores_;
  std::ofstream stream_;
};

}  // namespace kelpie::study
