// SPDX-License-Identifier: Apache-2.0
#include "study/evaluator.hpp"

#include <algorithm>
#include <utility>

#include "file/json.hpp"
#include "kelpie/kelpie.h"
#include "study/baselines.hpp"

namespace kelpie::study {
namespace {

using file::Json;

std::string identity_of(const TuneProblem& problem, const TuneOptions& options) {
  std::string text = std::string("kelpie ") + kelpie_version() + " tune";
  for (const auto& [name, value] : journal_header(problem, options)) {
    text.append("\n").append(name).append(": ").append(value);
  }
  return text;
}

std::string task_text(const EvaluationTask& task) {
  Json json = {{"log", task.key.log}, {"axis", task.axis}, {"rung", task.key.rung}};
  if (task.settings.axes.empty()) {
    json["yardstick"] = task.key.settings;
  } else {
    json["settings"] = file::object(task.settings.values());
  }
  return file::one_line(json);
}

ModelSettings settings_from(const Json& json) {
  ModelSettings settings = ModelSettings::from_preset(json.at("preset").get<std::string>(), 1);
  for (const auto& [name, value] : json.items()) {
    if (name != "preset") {
      settings.assign(name, value.get<std::string>());
    }
  }
  return settings;
}

LearnerFactory learner_from(const Json& task, const log::Dataset& data,
                            const TuneOptions& options) {
  if (task.contains("yardstick")) {
    return task.at("yardstick") == kMean ? mean_of_one_axis() : least_squares_of_one_axis(data);
  }
  return [&, settings = settings_from(task.at("settings"))] {
    return options.make_learner(data, settings);
  };
}

}  // namespace

Evaluator::Evaluator(const TuneProblem& problem, const ChainSet& chains, const TuneOptions& options,
                     jobs::Executor& executor, jobs::JournalPlace journal, double rows_planned)
    : problem_(problem),
      chains_(chains),
      options_(options),
      executor_(executor),
      journal_(std::move(journal)),
      identity_(identity_of(problem, options)),
      rows_planned_(rows_planned) {}

void Evaluator::run(const std::vector<EvaluationTask>& tasks, TuneJournal& journal) {
  std::vector<jobs::Job> missing;
  std::vector<const EvaluationTask*> of_job;
  double planned = 0.0;
  for (const EvaluationTask& task : tasks) {
    if (journal.has(task.key)) {
      rows_done_ += rows(task);
    } else {
      missing.push_back({task.key.text(), task_text(task), rows(task)});
      of_job.push_back(&task);
      planned += rows(task);
    }
  }
  jobs::Run run = run_of_all();
  run.jobs = missing;
  run.done = [&](std::size_t i, const std::string& result) { journal.add(of_job[i]->key, result); };
  run.keep_going = [&](double share) {
    return options_.keep_going(std::min(1.0, (rows_done_ + share * planned) / rows_planned_));
  };
  stopped_ = !executor_.run(run);
  rows_done_ += planned;
}

void Evaluator::help() {
  stopped_ = !executor_.run(run_of_all());
}

// What every process says of a run, whether it leads or not.
jobs::Run Evaluator::run_of_all() const {
  return {.jobs = {},
          .work = [this](const jobs::Job& job,
                         const jobs::Advance& advance) { return work(job, advance); },
          .done = {},
          .keep_going = options_.keep_going,
          .identity = identity_,
          .journal = journal_};
}

std::string Evaluator::work(const jobs::Job& job, const jobs::Advance& advance) const {
  const Json task = Json::parse(job.task);
  const auto log = task.at("log").get<std::size_t>();
  const auto rung = task.at("rung").get<std::size_t>();
  const auto planned = static_cast<double>(chains_[log].rungs()[rung].rows);
  std::size_t shown = 0;
  const auto watch = [&](std::size_t more) {
    shown += more;
    return advance(static_cast<double>(shown) / planned);
  };
  const ChainScore score = chains_[log].score(rung, task.at("axis").get<std::size_t>(),
                                              learner_from(task, problem_.logs[log].data, options_),
                                              options_.most_iterations, watch);
  return score.stopped ? "" : score_text(score);
}

double Evaluator::rows(const EvaluationTask& task) const {
  return static_cast<double>(chains_[task.key.log].rungs()[task.key.rung].rows);
}

}  // namespace kelpie::study
