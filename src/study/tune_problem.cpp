// SPDX-License-Identifier: Apache-2.0
#include "study/tune_problem.hpp"

#include <algorithm>
#include <bit>
#include <span>

#include "kelpie/core/error.hpp"
#include "kelpie/core/setting.hpp"
#include "kelpie/core/text.hpp"
#include "kelpie/model/dynamics_axis.hpp"
#include "kelpie/online/adaptive_svr.hpp"

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
  for (const std::size_t row : problem.rows) {
    add(problem.data.input(row));
    add(problem.data.target(row));
    add({&problem.data.times_s[row], 1});
  }
  return std::to_string(hash);
}

}  // namespace

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

TuneOptions TuneOptions::of_online_svr(const std::vector<std::string>& inputs,
                                       std::size_t targets) {
  TuneOptions options;
  options.make_learner = [inputs, targets](const ModelSettings& settings) {
    const TermSet terms = TermSet::from(settings.shared.terms, inputs, targets);
    return std::make_unique<DynamicsAxis>(inputs.size(), settings.shared, settings.axes.front(),
                                          terms);
  };
  return options;
}

void TuneOptions::validate() const {
  if (candidates < 1) {
    throw InputError("candidates", "0 is out of range; it has to be >= 1");
  }
  if (!(most_iterations > 0.0)) {
    throw InputError("most_iterations",
                     number_text(most_iterations) + " is out of range; it has to be > 0");
  }
}

TuneJournal::Header journal_header(const TuneProblem& problem, const TuneOptions& options,
                                   const std::string& split) {
  return {{"dataset", problem.data.source},
          {"rows", std::to_string(problem.rows.size())},
          {"inputs", join_text(problem.data.input_names, ",")},
          {"targets", join_text(problem.data.target_names, ",")},
          {"values", fingerprint(problem)},
          {"split", split},
          {"seed", std::to_string(options.seed)},
          {"space", problem.space.text()},
          {"warmup", std::to_string(problem.warmup())},
          {"most_iterations", number_text(options.most_iterations)}};
}

}  // namespace kelpie::study
