// SPDX-License-Identifier: Apache-2.0
#include "study/tune.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <span>

#include "core/text.hpp"
#include "study/baselines.hpp"
#include "study/evaluator.hpp"
#include "study/result.hpp"
#include "study/tune_problem.hpp"
#include "study/tuning.hpp"

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

namespace {

constexpr double kWorst = -std::numeric_limits<double>::infinity();
constexpr std::size_t kKeepOneIn = kTuning.chain.keep_one_in;
constexpr std::size_t kOthersBeside = 3;  // the references: the base, least squares, the mean

// How many of the candidates on a rung go on to the next.
std::size_t kept(std::size_t candidates) {
  return (candidates + kKeepOneIn - 1) / kKeepOneIn;
}

ModelSettings with(ModelSettings settings, const Assignments& assignments) {
  for (const auto& [name, text] : assignments) {
    settings.assign(name, text);
  }
  settings.validate();
  return settings;
}

// Scores of settings on all logs together, from the evaluations in a journal.
class TrialScores {
 public:
  TrialScores(const TuneProblem& problem, const ChainSet& chains, const TuneJournal& journal)
      : problem_(problem), chains_(chains), journal_(journal) {}

  // Of an evaluation on the log's rung that belongs to `rung`.
  EvaluationKey key(std::size_t log, std::size_t axis, std::size_t rung,
                    const std::string& settings) const {
    return {log, problem_.targets()[axis], chains_.rung_of(log, rung), settings};
  }

  // Nothing where a log's evaluation is missing.
  std::optional<TrialResult> trial(std::size_t axis, std::size_t rung,
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

  // Scores on all rows of the chosen settings, the base, the references and the baselines; without
  // TunedAxis::score and ::rung.
  TunedAxis outcome(std::size_t axis, const std::string& chosen) const {
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

 private:
  void fill(TunedAxis& outcome, std::size_t axis, const std::string& settings,
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

  const TuneProblem& problem_;
  const ChainSet& chains_;
  const TuneJournal& journal_;
};

// One axis under one combination of shared settings.
struct Bracket {
  std::size_t axis = 0;
  ModelSettings base;              // of that axis alone
  std::vector<std::size_t> alive;  // candidates, in the order they were drawn
  std::size_t best = 0;            // candidate
  std::size_t rung = 0;            // where it was the best
  double score = kUnknown;         // there
};

class Search {
 public:
  Search(const TuneProblem& problem, const TuneOptions& options, TuneJournal& journal,
         jobs::Executor& executor)
      : problem_(problem),
        journal_(journal),
        chains_(problem),
        trials_(problem, chains_, journal),
        candidates_(problem.space.candidates(options.seed, options.candidates)),
        evaluator_(problem, chains_, options, executor, rows_planned()) {
    std::vector<std::size_t> all(candidates_.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      all[i] = i;
    }
    for (const ModelSettings& base : problem.combinations()) {
      for (std::size_t axis = 0; axis < axes(); ++axis) {
        brackets_.push_back({.axis = axis, .base = one_axis(base, axis), .alive = all});
      }
    }
  }

  TuneResult run() {
    for (std::size_t rung = 0; rung < chains_.rungs() && !evaluator_.stopped(); ++rung) {
      climb(rung);
    }
    return finish();
  }

 private:
  std::size_t axes() const { return problem_.targets().size(); }
  std::size_t last_rung() const { return chains_.rungs() - 1; }

  // An upper bound: the base may have to be carried along beside the better third.
  double rows_planned() const {
    const std::size_t brackets = problem_.combinations().size() * axes();
    std::size_t alive = candidates_.size();
    std::size_t rows =
        axes() * (problem_.references.size() + kOthersBeside) * chains_.rows(last_rung());
    for (std::size_t rung = 0; rung < chains_.rungs(); ++rung) {
      rows += brackets * alive * chains_.rows(rung);
      alive = std::min(alive, kept(alive) + 1);
    }
    return static_cast<double>(rows);
  }

  ModelSettings settings_of_candidate(const Bracket& bracket, std::size_t candidate) const {
    return with(bracket.base, candidates_[candidate]);
  }

  void climb(std::size_t rung) {
    tasks_.clear();
    asked_.clear();
    for (const Bracket& bracket : brackets_) {
      for (const std::size_t candidate : bracket.alive) {
        ask(bracket.axis, rung, settings_of_candidate(bracket, candidate));
      }
    }
    for (std::size_t axis = 0; rung == last_rung() && axis < axes(); ++axis) {
      ask_others(axis);
    }
    evaluator_.run(tasks_, journal_);
    collect(rung);
    for (Bracket& bracket : brackets_) {
      promote(bracket, rung);
    }
  }

  // Has settings evaluated on every log.
  void ask(std::size_t axis, std::size_t rung, const ModelSettings& settings) {
    const std::string text = settings_of(settings, 0);
    if (asked_.insert({axis, text}).second) {
      for (std::size_t log = 0; log < chains_.logs(); ++log) {
        tasks_.push_back({trials_.key(log, axis, rung, text), axis, settings});
      }
    }
  }

  // Those whom the tuned settings are compared with.
  void ask_others(std::size_t axis) {
    ask(axis, last_rung(), one_axis(problem_.base, axis));
    for (const auto& [name, settings] : problem_.references) {
      ask(axis, last_rung(), one_axis(settings, axis));
    }
    for (std::size_t log = 0; log < chains_.logs(); ++log) {
      tasks_.push_back({trials_.key(log, axis, last_rung(), std::string(kMean)), axis});
      if (least_squares_of_one_axis(problem_.logs[log].data)) {
        tasks_.push_back({trials_.key(log, axis, last_rung(), std::string(kLeastSquares)), axis});
      }
    }
  }

  // What the rung has found. A short log's first rung is asked for more than once.
  void collect(std::size_t rung) {
    for (const EvaluationTask& task : tasks_) {
      if (task.settings.axes.empty() || !collected_.insert(task.key).second) {
        continue;
      }
      if (auto result = journal_.find(task.key)) {
        result_.evaluations.push_back({task.key, *std::move(result)});
      }
    }
    for (const EvaluationTask& task : tasks_) {
      if (!task.settings.axes.empty() && task.key.log == 0) {
        if (auto trial = trials_.trial(task.axis, rung, task.key.settings)) {
          result_.trials.push_back(*std::move(trial));
        }
      }
    }
  }

  // Ranks a bracket's candidates on a rung and lets the better third and the base go on; the base
  // alone where no candidate gains. Where a
  // search was stopped, what is known of half the candidates is no reason to change the choice,
  // but better than nothing on the first rung.
  void promote(Bracket& bracket, std::size_t rung) {
    std::vector<std::pair<double, std::size_t>> ranking;  // the best first
    std::size_t missing = 0;
    for (const std::size_t candidate : bracket.alive) {
      const auto trial = trials_.trial(bracket.axis, rung,
                                       settings_of(settings_of_candidate(bracket, candidate), 0));
      missing += trial ? 0 : 1;
      const bool finite = trial && std::isfinite(trial->score);
      ranking.emplace_back(finite ? -trial->score : -kWorst, candidate);
    }
    if (missing > 0 && rung > 0) {
      return;
    }
    const double base = ranking.front().second == 0 ? -ranking.front().first : kWorst;
    std::ranges::sort(ranking);
    if (std::isfinite(base) && -ranking.front().first < base + kTuning.chain.least_gain) {
      ranking = {{-base, 0}};  // the best of many is partly lucky: no gain
    }
    bracket.best = ranking.front().second;
    bracket.rung = rung;
    bracket.score = std::isfinite(ranking.front().first) ? -ranking.front().first : kUnknown;
    std::set<std::size_t> next{0};
    for (std::size_t i = 0; i < kept(ranking.size()); ++i) {
      next.insert(ranking[i].second);
    }
    bracket.alive.assign(next.begin(), next.end());
  }

  // The brackets of the combination with the best mean over the axes.
  std::span<const Bracket> best_brackets() const {
    std::span<const Bracket> best;
    double best_sum = kUnknown;
    for (std::size_t begin = 0; begin < brackets_.size(); begin += axes()) {
      const auto brackets = std::span(brackets_).subspan(begin, axes());
      double sum = 0.0;
      for (const Bracket& bracket : brackets) {
        // NOLINTNEXTLINE(bugprone-narrowing-conversions): both are double
        sum += std::isfinite(bracket.score) ? bracket.score : kWorst;
      }
      if (best.empty() || sum > best_sum) {
        best = brackets;
        best_sum = sum;
      }
    }
    return best;
  }

  TuneResult finish() {
    result_.tuned = problem_.base;
    result_.references = problem_.references;
    result_.interrupted = evaluator_.stopped();
    for (std::size_t rung = 0; rung < chains_.rungs(); ++rung) {
      result_.rungs.push_back(chains_.rows(rung));
    }
    for (std::size_t log = 0; log < chains_.logs(); ++log) {
      const TuneLog& one = problem_.logs[log];
      result_.logs.push_back({one.data.source, one.rows.size(), chains_[log].rungs()});
    }
    for (const Bracket& bracket : best_brackets()) {
      const ModelSettings chosen = settings_of_candidate(bracket, bracket.best);
      result_.tuned.shared = chosen.shared;
      result_.tuned.axes[bracket.axis] = chosen.axes.front();
      result_.axes.push_back(trials_.outcome(bracket.axis, settings_of(chosen, 0)));
      result_.axes.back().score = bracket.score;
      result_.axes.back().rung = bracket.rung;
    }
    return std::move(result_);
  }

  const TuneProblem& problem_;
  TuneJournal& journal_;
  ChainSet chains_;
  TrialScores trials_;
  std::vector<Assignments> candidates_;  // the first is the base as it stands
  Evaluator evaluator_;
  std::vector<Bracket> brackets_;                        // the axes of one combination side by side
  std::vector<EvaluationTask> tasks_;                    // of the rung
  std::set<std::pair<std::size_t, std::string>> asked_;  // axis and settings, on the rung
  std::set<EvaluationKey> collected_;
  TuneResult result_;
};

}  // namespace

TuneResult tune(const TuneProblem& problem, const TuneOptions& options, TuneJournal& journal,
                jobs::Executor& executor) {
  problem.validate();
  options.validate();
  return Search(problem, options, journal, executor).run();
}

}  // namespace kelpie::study
