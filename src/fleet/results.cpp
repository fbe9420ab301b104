// SPDX-License-Identifier: Apache-2.0
#include "fleet/results.hpp"

#include <fmt/format.h>

#include <utility>

#include "fleet/worker.hpp"
#include "kelpie/kelpie.h"

namespace kelpie::fleet {
namespace {

using file::Json;

constexpr const char* kKind = "kelpie-study-journal";

jobs::Run run_of(const Plan& plan, Worker& worker, const std::function<bool(double)>& keep_going) {
  return {.jobs = {},
          .work = [&worker](const jobs::Job& job,
                            const jobs::Advance& advance) { return worker(job, advance); },
          .done = [](std::size_t, const std::string&) {},
          .keep_going = keep_going,
          .identity = fmt::format("kelpie {}, study {}", kelpie_version(), plan.identity())};
}

// What is wrong with a log, by the name that it has in the study, wherever its folder is.
std::string with_name(const std::string& error, const Mission& mission) {
  const std::string file = mission.file.string();
  return error.starts_with(file) ? mission.log + error.substr(file.size()) : error;
}

}  // namespace

Results::Results(const Plan& plan, const std::vector<Mission>& missions,
                 const std::filesystem::path& folder)
    : plan_(plan),
      missions_(missions),
      combinations_(plan, missions.size()),
      journal_(folder / kJournalName, kKind, {{"kelpie", kelpie_version()}, {"study", plan.name}}) {
}

bool Results::run(jobs::Executor& executor, const std::function<bool(double)>& keep_going) {
  std::vector<std::size_t> missing;
  std::vector<jobs::Job> jobs;
  for (std::size_t i = 0; i < combinations_.size(); ++i) {
    jobs::Job job = job_of(plan_, missions_, combinations_[i]);
    if (!journal_.has(job.key)) {
      missing.push_back(i);
      jobs.push_back(std::move(job));
    }
  }
  Worker worker(plan_);
  jobs::Run run = run_of(plan_, worker, keep_going);
  run.jobs = jobs;
  run.done = [&](std::size_t i, const std::string& result) {
    const Json json = Json::parse(result);
    if (json.contains("error")) {
      const Mission& mission = missions_[combinations_[missing[i]].mission];
      failures_[missing[i]] = with_name(json.at("error").get<std::string>(), mission);
    } else {
      journal_.add(jobs[i].key, result);
    }
  };
  return executor.run(run);
}

std::size_t Results::done() const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < combinations_.size(); ++i) {
    count += journal_.has(key(i)) ? 1 : 0;
  }
  return count;
}

std::optional<Outcome> Results::outcome(std::size_t i) const {
  const std::string name = key(i);
  if (!journal_.has(name)) {
    return std::nullopt;
  }
  const std::string source = journal_.file().string();
  const Json json = file::parse_json(journal_.result(name), source);
  return read_outcome(file::JsonNode(json, source, "result"));
}

void help(const Plan& plan, jobs::Executor& executor,
          const std::function<bool(double)>& keep_going) {
  Worker worker(plan);
  executor.run(run_of(plan, worker, keep_going));
}

}  // namespace kelpie::fleet
