// SPDX-License-Identifier: Apache-2.0
#include "study/tune.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <span>

#include "kelpie/core/text.hpp"
#include "study/evaluator.hpp"
#include "study/result.hpp"
#include "study/yardsticks.hpp"

namespace kelpie::study {
namespace {

constexpr double kWorst = -std::numeric_limits<double>::infinity();
constexpr std::size_t kKeepOneIn = 3;

// How many of the candidates on a rung go on to the next.
std::size_t kept(std::size_t candidates) {
  return (candidates + kKeepOneIn - 1) / kKeepOneIn;
}

// What a candidate is ranked by: one that was given up or went astray comes last.
double rank(const std::optional<ChainScore>& result) {
  return result && std::isfinite(result->score) ? result->score
                                                : -std::numeric_limits<double>::infinity();
}

ModelSettings one_axis(const ModelSettings& settings, std::size_t axis) {
  return {settings.preset, settings.shared, {settings.axes[axis]}};
}

ModelSettings with(ModelSettings settings, const Assignments& assignments) {
  for (const auto& [name, text] : assignments) {
    settings.assign(name, text);
  }
  settings.validate();
  return settings;
}

std::string text_of(const ModelSettings& settings) {
  std::vector<std::string> parts;
  for (const auto& [name, value] : settings.values()) {
    if (name != "preset") {  // it says where values came from, not what they are
      parts.push_back(std::string(name).append("=").append(value));
    }
  }
  return join_text(parts, " ");
}

// One axis under one combination of shared settings.
struct Lane {
  std::size_t axis = 0;
  ModelSettings base;              // of that axis alone
  std::vector<std::size_t> alive;  // candidates, in the order they were drawn
  std::size_t best = 0;            // candidate
  std::size_t rung = 0;            // where it was the best
  double score = kUnknown;         // there
};

class Search {
 public:
  Search(const TuneProblem& problem, const TuneOptions& options, TuneJournal& journal)
      : problem_(problem),
        journal_(journal),
        chain_(problem.data, problem.rows, problem.warmup()),
        candidates_(problem.space.candidates(options.seed, options.candidates)),
        evaluator_(chain_, options, journal, rows_planned()) {
    std::vector<std::size_t> all(candidates_.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      all[i] = i;
    }
    for (const ModelSettings& base : problem.combinations()) {
      for (std::size_t axis = 0; axis < axes(); ++axis) {
        lanes_.push_back({.axis = axis, .base = one_axis(base, axis), .alive = all});
      }
    }
  }

  TuneResult run() {
    for (std::size_t rung = 0; rung < chain_.rungs().size() && !evaluator_.stopped(); ++rung) {
      const std::vector<Job> jobs = jobs_of(rung);
      evaluator_.run(jobs);
      collect(jobs);
      for (Lane& lane : lanes_) {
        promote(lane, rung);
      }
    }
    return finish();
  }

 private:
  std::size_t axes() const { return problem_.data.target_names.size(); }

  // An upper bound: the base may have to be carried along beside the better third.
  std::size_t rows_planned() const {
    const std::size_t lanes = problem_.combinations().size() * axes();
    std::size_t alive = candidates_.size();
    std::size_t rows = axes() * problem_.references.size() * problem_.rows.size();
    for (const Rung& rung : chain_.rungs()) {
      rows += lanes * alive * rung.rows;
      alive = std::min(alive, kept(alive) + 1);
    }
    return rows;
  }

  Job job(std::size_t axis, std::size_t rung, ModelSettings settings) const {
    std::string text = text_of(settings);
    return {axis, std::move(settings), {problem_.data.target_names[axis], rung, std::move(text)}};
  }

  Job job(const Lane& lane, std::size_t candidate, std::size_t rung) const {
    return job(lane.axis, rung, with(lane.base, candidates_[candidate]));
  }

  std::vector<Job> jobs_of(std::size_t rung) const {
    std::vector<Job> jobs;
    for (const Lane& lane : lanes_) {
      for (const std::size_t candidate : lane.alive) {
        jobs.push_back(job(lane, candidate, rung));
      }
    }
    if (rung + 1 == chain_.rungs().size()) {
      for (const auto& [name, settings] : problem_.references) {
        for (std::size_t axis = 0; axis < axes(); ++axis) {
          jobs.push_back(job(axis, rung, one_axis(settings, axis)));
        }
      }
    }
    std::set<EvaluationKey> seen;
    std::erase_if(jobs, [&seen](const Job& one) { return !seen.insert(one.key).second; });
    return jobs;
  }

  void collect(const std::vector<Job>& jobs) {
    for (const Job& one : jobs) {
      if (auto result = journal_.find(one.key)) {
        evaluations_.push_back({one.key, *std::move(result)});
      }
    }
  }

  // Ranks a lane's candidates on a rung and lets the better third and the base go on. Where a
  // search was stopped, what is known of half the candidates is no reason to change the choice,
  // but better than nothing on the first rung.
  void promote(Lane& lane, std::size_t rung) {
    std::vector<std::pair<double, std::size_t>> ranking;  // the best first
    std::size_t missing = 0;
    for (const std::size_t candidate : lane.alive) {
      const auto result = journal_.find(job(lane, candidate, rung).key);
      missing += result ? 0 : 1;
      ranking.emplace_back(-rank(result), candidate);
    }
    if (missing > 0 && rung > 0) {
      return;
    }
    std::ranges::sort(ranking);
    lane.best = ranking.front().second;
    lane.rung = rung;
    lane.score = std::isfinite(ranking.front().first) ? -ranking.front().first : kUnknown;
    std::set<std::size_t> next{0};
    for (std::size_t i = 0; i < kept(ranking.size()); ++i) {
      next.insert(ranking[i].second);
    }
    lane.alive.assign(next.begin(), next.end());
  }

  // The lanes of the combination with the best mean over the axes.
  std::span<const Lane> best_lanes() const {
    std::span<const Lane> best;
    double best_sum = kUnknown;
    for (std::size_t begin = 0; begin < lanes_.size(); begin += axes()) {
      const auto lanes = std::span(lanes_).subspan(begin, axes());
      double sum = 0.0;
      for (const Lane& lane : lanes) {
        sum += std::isfinite(lane.score) ? lane.score : kWorst;
      }
      if (best.empty() || sum > best_sum) {
        best = lanes;
        best_sum = sum;
      }
    }
    return best;
  }

  TuneResult finish() {
    TuneResult result{.tuned = problem_.base,
                      .axes = {},
                      .references = problem_.references,
                      .evaluations = std::move(evaluations_),
                      .rungs = chain_.rungs(),
                      .interrupted = evaluator_.stopped()};
    const std::size_t last = chain_.rungs().size() - 1;
    for (const Lane& lane : best_lanes()) {
      const ModelSettings chosen = with(lane.base, candidates_[lane.best]);
      result.tuned.shared = chosen.shared;
      result.tuned.axes[lane.axis] = chosen.axes.front();
      TunedAxis axis{problem_.data.target_names[lane.axis], lane.score, lane.rung, {}};
      for (const auto& [name, settings] : problem_.references) {
        const auto found = journal_.find(job(lane.axis, last, one_axis(settings, lane.axis)).key);
        axis.references.push_back(found ? found->score : kUnknown);
      }
      add_yardsticks(axis, lane.axis);
      result.axes.push_back(std::move(axis));
    }
    return result;
  }

  void add_yardsticks(TunedAxis& axis, std::size_t place) const {
    const auto score = [&](const LearnerFactory& make) {
      const auto watch = [](std::size_t) { return true; };
      return chain_.score(chain_.rungs().size() - 1, place, make, 1.0, watch).score;
    };
    if (const LearnerFactory make = least_squares_of_one_axis(problem_.data)) {
      axis.least_squares = score(make);
    }
    axis.mean = score(mean_of_one_axis());
  }

  const TuneProblem& problem_;
  TuneJournal& journal_;
  ForwardChain chain_;
  std::vector<Assignments> candidates_;  // the first is the base as it stands
  Evaluator evaluator_;
  std::vector<Lane> lanes_;  // the axes of one combination side by side
  std::vector<Evaluation> evaluations_;
};

}  // namespace

std::string settings_of(const ModelSettings& settings, std::size_t axis) {
  return text_of(one_axis(settings, axis));
}

TuneResult tune(const TuneProblem& problem, const TuneOptions& options, TuneJournal& journal) {
  options.validate();
  return Search(problem, options, journal).run();
}

}  // namespace kelpie::study
