// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/interrupt.hpp"
#include "cli/output.hpp"
#include "cli/progress.hpp"
#include "file/atomic_file.hpp"
#include "jobs/make_executor.hpp"
#include "kelpie/core/error.hpp"
#include "lab/commands.hpp"
#include "lab/fleet_report.hpp"

namespace kelpie::lab {
namespace {

struct FleetArguments {
  FleetPlan plan;
  std::size_t threads = 0;
  bool fresh = false;
  std::vector<std::size_t> ranks;
  std::string times;
  double median_s = 0.0;
  double sigma = 0.5;
  double message_us = 50.0;
  double latency_us = 500.0;
  double megabytes_per_s = 100.0;
  std::string out = "out/fleet";
};

void measure_fleet(const FleetArguments& options) {
  const cli::InterruptGuard guard;
  const auto executor = jobs::make_executor(options.threads);
  FleetPlan plan = options.plan;
  std::unique_ptr<cli::ProgressBar> progress;
  plan.keep_going = [&](double share) {
    if (progress) {
      progress->at(share);
    }
    return !cli::InterruptGuard::asked();
  };
  const std::filesystem::path journal = std::filesystem::path(options.out) / "journal.jsonl";
  bool complete = false;
  if (!executor->leads()) {
    run_fleet(*executor, plan, journal, complete);
    return;
  }
  const file::OutFolder folder = cli::take_out_folder(options.out, {"fleet.json"}, {});
  if (options.fresh) {
    std::filesystem::remove(journal);
  }
  progress = std::make_unique<cli::ProgressBar>("working");
  const FleetResult result = run_fleet(*executor, plan, journal, complete);
  progress.reset();
  if (!complete) {
    throw Failure("interrupted; the same command goes on with what is missing");
  }
  file::write_file_whole(folder.path() / "fleet.json", fleet_json(plan, result));
  fmt::print("{}numbers: {}\n", fleet_table(plan, result), (folder.path() / "fleet.json").string());
}

FleetTimes times_for(const FleetArguments& options, bool has_count) {
  if (options.times.empty()) {
    return lognormal_fleet_times(options.median_s, options.sigma, options.plan.jobs);
  }
  const FleetTimes read = read_fleet_times(options.times);
  return has_count ? draw_fleet_times(read, options.plan.jobs) : read;
}

void simulate_fleet(const FleetArguments& options, bool has_count) {
  const file::OutFolder folder =
      cli::take_out_folder(options.out, {"schedule.json"}, {options.times});
  const FleetTimes times = times_for(options, has_count);
  const std::vector<FleetSchedule> schedules =
      fleet_schedules(times, options.ranks,
                      {.message_s = 1e-6 * options.message_us,
                       .latency_s = 1e-6 * options.latency_us,
                       .bytes_per_job = static_cast<double>(options.plan.bytes),
                       .bytes_per_s = 1e6 * options.megabytes_per_s});
  file::write_file_whole(folder.path() / "schedule.json", schedule_json(times, schedules));
  fmt::print("{}numbers: {}\n", schedule_table(times, schedules),
             (folder.path() / "schedule.json").string());
}

void add_schedule_options(CLI::App& command, FleetArguments& options) {
  CLI::Option* const schedule =
      command
          .add_option("--schedule", options.ranks,
                      "instead, simulate what would become of the jobs on so many ranks: 1,64,1024")
          ->delimiter(',')
          ->check(CLI::PositiveNumber);
  CLI::Option* const times =
      command
          .add_option("--times", options.times,
                      "journal of a study, whose jobs' times are taken; with --jobs, drawn from")
          ->type_name("FILE")
          ->needs(schedule);
  CLI::Option* const median =
      command
          .add_option("--median", options.median_s,
                      "or a lognormal distribution of times with this median [s]")
          ->check(CLI::PositiveNumber)
          ->needs(schedule)
          ->excludes(times);
  command.add_option("--sigma", options.sigma, "and this standard deviation of their logarithm")
      ->check(CLI::NonNegativeNumber)
      ->needs(median)
      ->capture_default_str();
  command.add_option("--message", options.message_us, "the leader's time for a job [µs]")
      ->check(CLI::NonNegativeNumber)
      ->needs(schedule)
      ->capture_default_str();
  command
      .add_option("--latency", options.latency_us, "until a job begins, beyond the leader's [µs]")
      ->check(CLI::NonNegativeNumber)
      ->needs(schedule)
      ->capture_default_str();
  command.add_option("--bandwidth", options.megabytes_per_s, "of the leader's network [MB/s]")
      ->check(CLI::PositiveNumber)
      ->needs(schedule)
      ->capture_default_str();
}

void run_fleet_command(const FleetArguments& options, bool has_count) {
  if (options.ranks.empty()) {
    measure_fleet(options);
  } else if (options.times.empty() && options.median_s == 0.0) {
    throw InputError("--schedule", "needs times: --times JOURNAL or --median SECONDS");
  } else {
    simulate_fleet(options, has_count);
  }
}

}  // namespace

void add_fleet(CLI::App& app) {
  auto options = std::make_shared<FleetArguments>();
  CLI::App* const command = app.add_subcommand(
      "fleet", "Measure what executors take for made-up jobs, on threads or under mpirun");
  CLI::Option* const count = command->add_option("--jobs", options->plan.jobs, "how many")
                                 ->check(CLI::PositiveNumber)
                                 ->capture_default_str();
  command->add_option("--job-ms", options->plan.job_ms, "how long they are, about [ms]")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--bytes", options->plan.bytes, "of each result")->capture_default_str();
  command->add_flag("--idle", options->plan.idle, "jobs sleep instead of calculating");
  command->add_option("--threads", options->threads, "jobs at a time; 0: one per core")
      ->capture_default_str();
  command->add_flag("--fresh", options->fresh, "begin anew, whatever journal there is");
  add_schedule_options(*command, *options);
  command->add_option("--out", options->out, "folder for fleet.json, schedule.json, the journal")
      ->capture_default_str()
      ->type_name("FOLDER");
  command->callback([options, count] { run_fleet_command(*options, count->count() > 0); });
}

}  // namespace kelpie::lab
