// SPDX-License-Identifier: Apache-2.0
#include "study/evaluator.hpp"

#include <algorithm>

#include "study/baselines.hpp"

namespace kelpie::study {
namespace {

LearnerFactory learner_of(const EvaluationTask& task, const log::Dataset& data,
                          const TuneOptions& options) {
  if (task.settings.axes.empty()) {
    return task.key.settings == kMean ? mean_of_one_axis() : least_squares_of_one_axis(data);
  }
  return [&] { return options.make_learner(data, task.settings); };
}

}  // namespace

Evaluator::Evaluator(const TuneProblem& problem, const ChainSet& chains, const TuneOptions& options,
                     jobs::Executor& executor, double rows_planned)
    : problem_(problem),
      chains_(chains),
      options_(options),
      executor_(executor),
      rows_planned_(rows_planned) {}

void Evaluator::run(const std::vector<EvaluationTask>& tasks, TuneJournal& journal) {
  std::vector<jobs::Job> missing;
  std::vector<const EvaluationTask*> of_job;
  double planned = 0.0;
  for (const EvaluationTask& task : tasks) {
    if (journal.has(task.key)) {
      rows_done_ += rows(task);
    } else {
      missing.push_back({.cost = rows(task)});
      of_job.push_back(&task);
      planned += rows(task);
    }
  }
  stopped_ = !executor_.run(
      {.jobs = missing,
       .work = [&](std::size_t i,
                   const jobs::Advance& advance) { return work(*of_job[i], advance); },
       .done = [&](std::size_t i,
                   const std::string& result) { journal.add(of_job[i]->key, result); },
       .keep_going =
           [&](double share) {
             return options_.keep_going(
                 std::min(1.0, (rows_done_ + share * planned) / rows_planned_));
           }});
  rows_done_ += planned;
}

std::string Evaluator::work(const EvaluationTask& task, const jobs::Advance& advance) const {
  const std::size_t log = task.key.log;
  std::size_t shown = 0;
  const auto watch = [&](std::size_t more) {
    shown += more;
    return advance(static_cast<double>(shown) / rows(task));
  };
  const ChainScore score = chains_[log].score(task.key.rung, task.axis,
                                              learner_of(task, problem_.logs[log].data, options_),
                                              options_.most_iterations, watch);
  return score.stopped ? "" : score_text(score);
}

double Evaluator::rows(const EvaluationTask& task) const {
  return static_cast<double>(chains_[task.key.log].rungs()[task.key.rung].rows);
}

}  // namespace kelpie::study
