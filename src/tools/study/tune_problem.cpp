// SPDX-License-Identifier: Apache-2.0
#include "study/tune_problem.hpp"

#include <algorithm>
#include <bit>
#include <iterator>
#include <set>
#include <span>

#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/setting.hpp"
#include "kelpie/motion/term_set.hpp"
#include "model/model_axis.hpp"
#include "motion/states.hpp"
#include "study/training_scales.hpp"

namespace kelpie::study {
namespace {

// FNV-1a over the values a search sees: another log under the same name is another search.
std::string fingerprint(const TuneProblem& problem) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  const auto add = [&hash](std::span<const double> values) {
    for (const double value : values) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x100000001b3ULL;
      hash ^= hash >> 32U;
    }
  };
  for (const TuneLog& log : problem.logs) {
    for (const std::size_t row : log.rows) {
      add(log.data.input(row));
      add(log.data.target(row));
      add({&log.data.times_s[row], 1});
    }
  }
  return std::to_string(hash);
}

// Of every log, once where they agree: "9567", "9567, 4012".
template <typename Text>
std::string of_logs(const TuneProblem& problem, Text text_of) {
  std::vector<std::string> texts;
  for (const TuneLog& log : problem.logs) {
    texts.push_back(text_of(log));
  }
  const bool alike = std::ranges::count(texts, texts.front()) == std::ssize(texts);
  return alike ? texts.front() : join_text(texts, "; ");
}

void check_targets(const TuneLog& log, const TuneProblem& problem) {
  if (log.data.target_names != problem.targets()) {
    throw InputError({.file = log.data.source, .line = 0, .field = "targets"},
                     "are " + join_text(log.data.target_names, ",") + "; those of " +
                         problem.logs.front().data.source + " are " +
                         join_text(problem.targets(), ",") +
                         "; --targets names those to tune on in every log");
  }
}

// Whether the log has the columns that settings name, and the scaling can be found.
void check_settings(const TuneLog& log, const ModelSettings& settings) {
  try {
    training_scales(log.data, log.rows, settings.shared);
  } catch (const InputError& error) {
    if (error.place().file.empty()) {  // TermSet doesn't know whose columns they are
      throw InputError({.file = log.data.source, .line = 0, .field = "terms"}, error.what());
    }
    throw;
  }
}

}  // namespace

void TuneProblem::validate() const {
  std::set<std::string> sources;
  for (const TuneLog& log : logs) {
    if (!sources.insert(log.data.source).second) {
      throw InputError({.file = log.data.source, .line = 0, .field = {}},
                       "is given twice: it would count twice");
    }
    check_targets(log, *this);
    for (const ModelSettings& settings : combinations()) {
      check_settings(log, settings);
    }
  }
}

std::vector<ModelSettings> TuneProblem::combinations() const {
  std::vector<ModelSettings> list;
  for (const Assignments& shared : space.shared_combinations()) {
    ModelSettings& settings = list.emplace_back(base);
    for (const auto& [name, text] : shared) {
      settings.assign(name, text);
    }
    settings.validate();
  }
  return list;
}

std::size_t TuneProblem::warmup() const {
  int longest = 0;
  for (const ModelSettings& settings : combinations()) {
    longest = std::max(longest, settings.shared.warmup);
  }
  return static_cast<std::size_t>(longest);
}

std::unique_ptr<OnlineRegressor> TuneOptions::online_learner(const log::Dataset& data,
                                                             const ModelSettings& settings) {
  const TermSet terms =
      TermSet::from(settings.shared.terms, data.input_names, data.target_names.size());
  return make_axis(data.input_names.size(), settings.shared, settings.axes.front(), terms,
                   find_states(settings.shared.states, data.input_names, data.target_names.size()));
}

void TuneOptions::validate() const {
  require_range("candidates", static_cast<double>(candidates), {.low = 1.0});
  if (!(most_iterations > 0.0)) {
    throw InputError("most_iterations",
                     number_text(most_iterations) + " is out of range; it has to be > 0");
  }
}

TuneJournal::Header journal_header(const TuneProblem& problem, const TuneOptions& options) {
  const auto of = [&](auto text_of) { return of_logs(problem, text_of); };
  return {{"dataset", of([](const TuneLog& log) { return log.data.source; })},
          {"rows", of([](const TuneLog& log) { return std::to_string(log.rows.size()); })},
          {"inputs", of([](const TuneLog& log) { return join_text(log.data.input_names, ","); })},
          {"targets", join_text(problem.targets(), ",")},
          {"values", fingerprint(problem)},
          {"split", of([](const TuneLog& log) { return log.split; })},
          {"seed", std::to_string(options.seed)},
          {"space", problem.space.text()},
          {"warmup", std::to_string(problem.warmup())},
          {"most_iterations", number_text(options.most_iterations)}};
}

ChainSet::ChainSet(const TuneProblem& problem) {
  for (const TuneLog& log : problem.logs) {
    chains_.emplace_back(log.data, log.rows, problem.warmup());
    rungs_ = std::max(rungs_, chains_.back().rungs().size());
  }
}

std::size_t ChainSet::rung_of(std::size_t log, std::size_t rung) const {
  const std::size_t fewer = rungs_ - chains_[log].rungs().size();
  return rung < fewer ? 0 : rung - fewer;
}

std::size_t ChainSet::rows(std::size_t rung) const {
  std::size_t rows = 0;
  for (std::size_t log = 0; log < logs(); ++log) {
    rows += chains_[log].rungs()[rung_of(log, rung)].rows;
  }
  return rows;
}

}  // namespace kelpie::study
