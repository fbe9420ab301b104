// SPDX-License-Identifier: Apache-2.0
#include "lab/fleet_report.hpp"

#include <fmt/format.h>

#include <numeric>

#include "chart/text_table.hpp"
#include "chart/wording.hpp"
#include "file/json.hpp"

namespace kelpie::lab {
namespace {

double sum_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

double each(double all, std::size_t count) {
  return all / static_cast<double>(count);  // NaN without any
}

file::Json schedule_row(const FleetSchedule& schedule) {
  const auto of = [](const jobs::Schedule& what) {
    return file::Json{{"makespan_s", what.makespan_s},
                      {"efficiency", what.efficiency},
                      {"leader_busy", what.leader_busy}};
  };
  return {{"ranks", schedule.settings.ranks},
          {"longest_first", of(schedule.longest_first)},
          {"as_given", of(schedule.as_given)}};
}

}  // namespace

std::string fleet_table(const FleetPlan& plan, const FleetResult& result) {
  chart::TextTable table{
      fmt::format("{} made-up jobs of {:g} ms{}, {} bytes each, {} at a time",
                  chart::grouped(plan.jobs), plan.job_ms, plan.idle ? " (idle)" : "",
                  chart::grouped(plan.bytes), result.workers),
      {"", ""},
      {}};
  const auto row = [&](const std::string& name, const std::string& value) {
    table.rows.push_back({name, value});
  };
  row("in the journal before", chart::grouped(result.found));
  row("done", chart::grouped(result.done));
  row("… by other processes", chart::grouped(result.sent));
  row("time", chart::duration(1e6 * result.wall_s));
  row("efficiency", chart::decimal(result.efficiency()));
  row("overhead of a job", chart::duration(1e3 * result.overhead_ms()));
  row("leader's processor time for a job", chart::duration(each(result.leader_us, result.done)));
  row("leader's memory for a job",
      chart::significant(each(result.leader_bytes, result.done)) + " bytes");
  row("journal for a job",
      chart::significant(each(static_cast<double>(result.journal_bytes), plan.jobs)) + " bytes");
  row("jobs per second", chart::significant(static_cast<double>(result.done) / result.wall_s));
  row("value of all results", fmt::format("{:08x}", result.value));
  return chart::table_text(table);
}

std::string fleet_json(const FleetPlan& plan, const FleetResult& result) {
  const file::Json json = {
      {"format", "kelpie-fleet"},
      {"version", 1},
      {"jobs", plan.jobs},
      {"job_ms", plan.job_ms},
      {"bytes", plan.bytes},
      {"idle", plan.idle},
      {"workers", result.workers},
      {"found", result.found},
      {"done", result.done},
      {"sent", result.sent},
      {"wall_s", result.wall_s},
      {"efficiency", file::number(result.efficiency())},
      {"overhead_ms", file::number(result.overhead_ms())},
      {"leader_us_per_job", file::number(each(result.leader_us, result.done))},
      {"leader_bytes_per_job", file::number(each(result.leader_bytes, result.done))},
      {"journal_bytes", result.journal_bytes},
      {"value", fmt::format("{:08x}", result.value)}};
  return file::json_text(json, 1);
}

std::string schedule_table(const FleetTimes& times, const std::vector<FleetSchedule>& schedules) {
  const jobs::ScheduleSettings& settings = schedules.front().settings;
  chart::TextTable table{
      fmt::format("Simulated schedules: {}, {} together", times.source,
                  chart::duration(1e6 * sum_of(times.seconds))),
      {"ranks", "longest first", "efficiency", "as given", "efficiency", "leader busy"},
      {},
      {fmt::format(
          "the leader takes {} for a job, and {} bytes at {:.3g} MB/s; a job begins {} later",
          chart::duration(1e6 * settings.message_s), settings.bytes_per_job,
          1e-6 * settings.bytes_per_s, chart::duration(1e6 * settings.latency_s))}};
  for (const FleetSchedule& schedule : schedules) {
    table.rows.push_back({chart::grouped(schedule.settings.ranks),
                          chart::duration(1e6 * schedule.longest_first.makespan_s),
                          chart::decimal(schedule.longest_first.efficiency),
                          chart::duration(1e6 * schedule.as_given.makespan_s),
                          chart::decimal(schedule.as_given.efficiency),
                          fmt::format("{:.2g} %", 100.0 * schedule.longest_first.leader_busy)});
  }
  return chart::table_text(table);
}

std::string schedule_json(const FleetTimes& times, const std::vector<FleetSchedule>& schedules) {
  const jobs::ScheduleSettings& settings = schedules.front().settings;
  const file::Json json = {{"format", "kelpie-fleet-schedule"},
                           {"version", 1},
                           {"simulated", true},
                           {"times", times.source},
                           {"jobs", times.seconds.size()},
                           {"job_s", sum_of(times.seconds)},
                           {"message_s", settings.message_s},
                           {"latency_s", settings.latency_s},
                           {"bytes_per_job", settings.bytes_per_job},
                           {"bytes_per_s", settings.bytes_per_s},
                           {"schedules", file::list(schedules, schedule_row)}};
  return file::json_text(json, 1);
}

}  // namespace kelpie::lab
