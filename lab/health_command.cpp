// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "cli/output.hpp"
#include "core/quantile.hpp"
#include "health/card.hpp"
#include "health/factors.hpp"
#include "kelpie/core/random.hpp"
#include "lab/commands.hpp"
#include "simulator/parameters.hpp"
#include "simulator/scenario_file.hpp"

namespace kelpie::lab {
namespace {

constexpr double kWeekDays = 7.0;
constexpr double kMinuteS = 60.0;

struct HealthStudyArguments {
  std::string scenario;
  std::size_t seeds = 20;
  std::size_t clean_weeks = 8;
  std::size_t fouled_weeks = 4;
  std::size_t dives = 2;  // a week
  double minutes = 20.0;
  double percent = 1.0;  // growth of the drag in a week
  std::size_t noise = 0;
};

struct HealthStudy {
  std::vector<std::size_t> found_week{};  // of fouling, by seed; 0: not found
  std::size_t false_reports = 0;          // of other quantities, and before the fouling
  std::size_t tests = 0;                  // of a vehicle, one a week
  std::size_t inside = 0;                 // last change of drag in its 90 % interval
  std::size_t drifts = 0;                 // last reports that say drift
  double mean_error = 0.0;                // told standard error of surge drag in a dive
  std::size_t dives = 0;
};

health::DriveLog dive(const HealthStudyArguments& options, simulator::Scenario scenario,
                      std::size_t seed, std::size_t number) {
  const double week = static_cast<double>(number) / static_cast<double>(options.dives);
  const double fouled = std::max(0.0, week - static_cast<double>(options.clean_weeks));
  scenario.seed = 100'000 * (seed + 1) + number;
  scenario.phases.front().duration_s = kMinuteS * options.minutes;
  scenario.configurations.front().damping_factor *= 1.0 + 0.01 * options.percent * fouled;
  const std::string name = "dive " + std::to_string(number + 1);
  return {.data = simulated_log(scenario, name), .mission = name, .day = kWeekDays * week};
}

bool tells(const health::HealthCard& card, const std::string& quantity) {
  return std::ranges::any_of(card.changes, [&](const health::Change& change) {
    return card.table.quantities[change.quantity].name == quantity &&
           health::is_found(change.course);
  });
}

std::size_t reports(const health::HealthCard& card, bool drag_is_right) {
  return static_cast<std::size_t>(
      std::ranges::count_if(card.changes, [&](const health::Change& change) {
        const std::string& name = card.table.quantities[change.quantity].name;
        return health::is_found(change.course) && !(drag_is_right && name.ends_with(" drag"));
      }));
}

// The episodes of the first weeks alone.
health::HealthTable until(const health::HealthTable& table, double day) {
  health::HealthTable part{.quantities = table.quantities, .episodes = {}, .estimates = {}};
  for (std::size_t i = 0; i < table.episodes.size(); ++i) {
    if (table.episodes[i].day < day) {
      part.episodes.push_back(table.episodes[i]);
      part.estimates.push_back(table.estimates[i]);
    }
  }
  return part;
}

void judge_last(const HealthStudyArguments& options, const health::HealthCard& card,
                HealthStudy& study) {
  for (const health::Change& change : card.changes) {
    if (card.table.quantities[change.quantity].name != "surge drag" ||
        !health::is_found(change.course)) {
      continue;
    }
    const double last = card.table.episodes.back().day / kWeekDays;
    const double truth = 0.01 * options.percent * (last - static_cast<double>(options.clean_weeks));
    const health::Estimate size = change.course.change;
    const double relative = size.value / change.course.before.value;
    study.inside +=
        std::abs(relative - truth) <= kNormal90 * size.error / change.course.before.value ? 1 : 0;
    study.drifts += change.course.kind == health::CourseKind::drift ? 1 : 0;
  }
}

// The common fit is of all dives so far, in every week after the clean weeks; before, of the clean
// weeks.
void study_seed(const HealthStudyArguments& options, const simulator::Scenario& scenario,
                std::size_t seed, HealthStudy& study) {
  std::vector<health::DriveLog> logs;
  std::size_t found = 0;
  for (std::size_t week = 1; week <= options.clean_weeks + options.fouled_weeks; ++week) {
    while (logs.size() < week * options.dives) {
      logs.push_back(dive(options, scenario, seed, logs.size()));
    }
    if (week < options.clean_weeks) {
      continue;
    }
    const health::HealthTable table = health::judge_drives(logs, {.velocities = {0, 1, 2}});
    for (std::size_t at = week == options.clean_weeks ? 1 : week; at <= week; ++at) {
      const bool fouled = at > options.clean_weeks && options.percent != 0.0;
      const health::HealthCard card = health::make_card(
          "simulated", true, until(table, kWeekDays * static_cast<double>(at)), {});
      study.false_reports += reports(card, fouled);
      ++study.tests;
      if (fouled && found == 0 && tells(card, "surge drag")) {
        found = at - options.clean_weeks;
      }
      if (fouled && at == options.clean_weeks + options.fouled_weeks) {
        judge_last(options, card, study);
      }
    }
    for (const std::vector<health::Estimate>& estimates : table.estimates) {
      study.mean_error += estimates.front().error;
      ++study.dives;
    }
  }
  study.found_week.push_back(found);
}

std::string health_text(const HealthStudyArguments& options, const HealthStudy& study) {
  std::string text = fmt::format(
      "{} seeds, {} dives of {:g} minutes a week, {} clean weeks, then {:g} % of drag a week for "
      "{} "
      "weeks\nstandard error of surge drag in a dive: {:.2f} %\n{} false reports in {} weekly "
      "tests "
      "of a vehicle\n",
      options.seeds, options.dives, options.minutes, options.clean_weeks, options.percent,
      options.fouled_weeks, 100.0 * study.mean_error / static_cast<double>(study.dives),
      study.false_reports, study.tests);
  if (options.percent != 0.0) {
    for (std::size_t week = 1; week <= options.fouled_weeks; ++week) {
      text += fmt::format(
          "found within {} weeks: {} of {}\n", week,
          std::ranges::count_if(study.found_week,
                                [&](std::size_t found) { return found > 0 && found <= week; }),
          options.seeds);
    }
    text += fmt::format("after {} weeks: called a drift {}, in the 90 % interval {}\n",
                        options.fouled_weeks, study.drifts, study.inside);
  }
  return text;
}

// Series of noise alone, one value a week for a year, judged every week; `told`: told errors over
// the true ones.
std::size_t reports_on_noise(std::size_t count, double told) {
  constexpr std::size_t kWeeks = 52;
  RandomStream random(1, "health");
  std::size_t reported = 0;
  for (std::size_t i = 0; i < count; ++i) {
    health::Series series;
    bool found = false;
    for (std::size_t week = 0; week < kWeeks; ++week) {
      series.days.push_back(kWeekDays * static_cast<double>(week));
      series.estimates.push_back({random.normal(), told});
      found |= health::is_found(health::judge(series));
    }
    reported += found ? 1 : 0;
  }
  return reported;
}

void run_health_study(const HealthStudyArguments& options) {
  if (options.noise > 0) {
    for (const double told : {1.0, 0.5, 1.0 / 3.0}) {
      cli::say(
          "told errors {:.2f} of the true ones: {} of {} series of noise had a report in a "
          "year of weekly tests\n",
          told, reports_on_noise(options.noise, told), options.noise);
    }
    return;
  }
  const simulator::Scenario scenario =
      simulator::read_scenario(scenario_file(options.scenario, "identify.toml"));
  simulator::require_plane(scenario.vehicle);
  HealthStudy study;
  run_watched("diving", [&](const auto& keep_going) {
    for (std::size_t seed = 0; seed < options.seeds; ++seed) {
      study_seed(options, scenario, seed, study);
      if (!keep_going(static_cast<double>(seed + 1) / static_cast<double>(options.seeds))) {
        break;
      }
    }
    return 0;
  });
  cli::say("{}", health_text(options, study));
}

}  // namespace

void add_health(CLI::App& app) {
  const auto [command, options] =
      cli::add_command<HealthStudyArguments>(app, "health",
                                             "Simulate dives of a vehicle whose drag grows: when "
                                             "`kelpie health` finds the change, and how "
                                             "often it reports what is not there",
                                             run_health_study);
  cli::add_file(command, "--scenario", options->scenario,
                "scenario of one configuration and phase; else identify.toml");
  add_seeds(command, options->seeds, "vehicles");
  command->add_option("--clean", options->clean_weeks, "weeks without a change")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--fouled", options->fouled_weeks, "weeks after these")
      ->capture_default_str();
  command->add_option("--dives", options->dives, "a week")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--minutes", options->minutes, "of a dive")
      ->check(cli::within(1.0, 1e4))
      ->capture_default_str();
  command->add_option("--percent", options->percent, "growth of all drag in a week")
      ->check(cli::within(-100.0, 100.0))
      ->capture_default_str();
  command->add_option("--noise", options->noise,
                      "instead: so many series of noise alone, one value a week for a year");
}

}  // namespace kelpie::lab
