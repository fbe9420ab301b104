// SPDX-License-Identifier: Apache-2.0
#include "study/trial_scores.hpp"

#include <vector>

#include "kelpie/core/text.hpp"
#include "study/evaluator.hpp"
#include "study/result.hpp"

namespace kelpie::study {

ModelSettings one_axis(const ModelSettings& settings, std::size_t axis) {
  return {settings.preset, settings.shared, {settings.axes[axis]}};
}

std::string settings_of(const ModelSettings& settings, std::size_t axis) {
  std::vector<std::string> parts;
  for (const auto& [name, value] : one_axis(settings, axis).values()) {
    if (name != "preset") {  // it says where values came from, not what they are
      parts.push_back(std::string(name).append("=").append(value));
    }
  }
  return join_text(parts, " ");
}

EvaluationKey TrialScores::key(std::size_t log, std::size_t axis, std::size_t rung,
                               const std::string& settings) const {
  return {log, problem_.targets()[axis], chains_.rung_of(log, rung), settings};
}

std::optional<TrialResult> TrialScores::trial(std::size_t axis, std::size_t rung,
                                              const std::string& settings) const {
  TrialResult result{.axis = problem_.targets()[axis], .rung = rung, .settings = settings};
  const auto logs = static_cast<double>(chains_.logs());
  for (std::size_t log = 0; log < chains_.logs(); ++log) {
    const auto found = journal_.find(key(log, axis, rung, settings));
    if (!found) {
      return std::nullopt;
    }
    result.score += found->score / logs;
    result.iterations_per_row += found->iterations_per_row / logs;
    result.given_up = result.given_up || found->given_up;
  }
  return result;
}

TunedAxis TrialScores::outcome(std::size_t axis, const std::string& chosen) const {
  TuneScores none;
  none.references.assign(problem_.references.size(), kUnknown);
  TunedAxis outcome{.name = problem_.targets()[axis],
                    .all = none,
                    .logs = std::vector<TuneScores>(chains_.logs(), none)};
  const auto score = [&](const std::string& settings, auto place) {
    fill(outcome, axis, settings, place);
  };
  score(chosen, [](TuneScores& scores) -> double& { return scores.tuned; });
  score(settings_of(problem_.base, axis),
        [](TuneScores& scores) -> double& { return scores.base; });
  for (std::size_t i = 0; i < problem_.references.size(); ++i) {
    score(settings_of(problem_.references[i].second, axis),
          [i](TuneScores& scores) -> double& { return scores.references[i]; });
  }
  score(std::string(kLeastSquares),
        [](TuneScores& scores) -> double& { return scores.least_squares; });
  score(std::string(kMean), [](TuneScores& scores) -> double& { return scores.mean; });
  return outcome;
}

void TrialScores::fill(TunedAxis& outcome, std::size_t axis, const std::string& settings,
                       const std::function<double&(TuneScores&)>& place) const {
  double sum = 0.0;
  for (std::size_t log = 0; log < chains_.logs(); ++log) {
    const auto found = journal_.find(key(log, axis, chains_.rungs() - 1, settings));
    const double score = found ? found->score : kUnknown;
    place(outcome.logs[log]) = score;
    sum += score;
  }
  place(outcome.all) = sum / static_cast<double>(chains_.logs());
}

}  // namespace kelpie::study
