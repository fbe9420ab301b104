// SPDX-License-Identifier: Apache-2.0
#include "lab/fleet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <span>
#include <thread>

#include "file/crc32.hpp"
#include "file/json.hpp"
#include "jobs/journal.hpp"
#include "kelpie/core/random.hpp"
#include "lab/bench_parts.hpp"
#include "lab/process_costs.hpp"

namespace kelpie::lab {
namespace {

using file::Json;

constexpr const char* kFleetJournal = "kelpie-fleet-journal";
constexpr double kSliceMs = 1.0;

std::uint32_t fleet_sum(const std::string& text, std::uint32_t before = 0) {
  return file::crc32_of(std::as_bytes(std::span(text)), before);
}

std::vector<jobs::Job> fleet_jobs(const FleetPlan& plan) {
  RandomStream random(1, "fleet");
  std::vector<jobs::Job> list;
  for (std::size_t i = 0; i < plan.jobs; ++i) {
    const double ms = plan.job_ms * random.uniform(0.5, 1.5);
    const Json task = {{"ms", ms}, {"bytes", plan.bytes}, {"idle", plan.idle}};
    list.push_back({fmt::format("job {}", i), task.dump(), std::max(ms, 1e-6)});
  }
  return list;
}

// False when nobody waits for it any more.
bool spend(double ms, bool idle, const jobs::Advance& advance) {
  double slept_ms = 0.0;
  const double start_us = thread_time_us();
  const auto spent = [&] { return idle ? slept_ms : 1e-3 * (thread_time_us() - start_us); };
  for (double asked = 0.0; spent() < ms;) {
    if (idle) {
      const double slice = std::min(kSliceMs, ms - slept_ms);
      slept_ms += 1e-3 * timed_us([&] {
                    std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(slice));
                  });
    }
    if (spent() - asked >= kSliceMs) {
      asked = spent();
      if (!advance(std::min(1.0, asked / ms))) {
        return false;
      }
    }
  }
  return true;
}

std::string do_fleet_job(const jobs::Job& job, const jobs::Advance& advance) {
  const Json task = Json::parse(job.task);
  const double us =
      timed_us([&] { spend(task.at("ms").get<double>(), task.at("idle").get<bool>(), advance); });
  return Json{{"seconds", 1e-6 * us},
              {"value", fmt::format("{:08x}", fleet_sum(job.key))},
              {"filler", std::string(task.at("bytes").get<std::size_t>(), 'x')}}
      .dump();
}

// Of those that `journal` has no result of, with their places.
std::vector<jobs::Job> missing_jobs(const std::vector<jobs::Job>& all,
                                    const jobs::Journal& journal) {
  std::vector<jobs::Job> missing;
  std::ranges::copy_if(all, std::back_inserter(missing),
                       [&](const jobs::Job& job) { return !journal.has(job.key); });
  return missing;
}

std::uint32_t fleet_value(const std::vector<jobs::Job>& all, const jobs::Journal& journal) {
  std::uint32_t sum = 0;
  for (const jobs::Job& job : all) {
    if (journal.has(job.key)) {
      const Json result = Json::parse(journal.result(job.key));
      sum = fleet_sum(job.key + " " + result.at("value").get<std::string>() + "\n", sum);
    }
  }
  return sum;
}

std::string fleet_identity(const FleetPlan& plan) {
  return fmt::format("fleet of {} jobs, {:g} ms, {} bytes{}", plan.jobs, plan.job_ms, plan.bytes,
                     plan.idle ? ", idle" : "");
}

bool lead_fleet(jobs::Executor& executor, const FleetPlan& plan, jobs::Run run,
                jobs::Journal& journal, FleetResult& result) {
  const std::vector<jobs::Job> all = fleet_jobs(plan);
  const std::vector<jobs::Job> missing = missing_jobs(all, journal);
  result.workers = executor.workers();
  result.found = all.size() - missing.size();
  std::atomic<std::size_t> here{0};
  std::size_t first_bytes = 0;
  run.jobs = missing;
  run.work = [&](const jobs::Job& job, const jobs::Advance& advance) {
    ++here;
    return do_fleet_job(job, advance);
  };
  run.done = [&](std::size_t i, const std::string& text) {
    journal.add(missing[i].key, text);
    result.job_s += Json::parse(text).at("seconds").get<double>();
    first_bytes = ++result.done == 1 ? resident_bytes() : first_bytes;
  };
  const double begin_us = thread_time_us();
  bool complete = false;
  result.wall_s = 1e-6 * timed_us([&] { complete = executor.run(run); });
  result.leader_us = thread_time_us() - begin_us;
  result.leader_bytes = static_cast<double>(resident_bytes()) - static_cast<double>(first_bytes);
  result.sent = result.done - std::min<std::size_t>(here, result.done);
  result.value = fleet_value(all, journal);
  return complete;
}

}  // namespace

double FleetResult::efficiency() const {
  return job_s / (wall_s * static_cast<double>(workers));
}

double FleetResult::overhead_ms() const {
  return 1e3 * (wall_s * static_cast<double>(workers) - job_s) / static_cast<double>(done);
}

FleetResult run_fleet(jobs::Executor& executor, const FleetPlan& plan,
                      const std::filesystem::path& journal, bool& complete) {
  const jobs::Run run{
      .work = do_fleet_job, .keep_going = plan.keep_going, .identity = fleet_identity(plan)};
  FleetResult result;
  if (executor.leads()) {
    jobs::Journal kept(journal, kFleetJournal, {{"plan", run.identity}});
    complete = lead_fleet(executor, plan, run, kept, result);
    result.journal_bytes = std::filesystem::file_size(journal);
  } else {
    complete = executor.run(run);
  }
  return result;
}

}  // namespace kelpie::lab
