// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>

#include "file/json.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "lab/fleet.hpp"

namespace kelpie::lab {

FleetTimes read_fleet_times(const std::filesystem::path& journal) {
  FleetTimes times{journal.filename().string(), {}};
  std::istringstream lines(file::read_text(journal, "a journal"));
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    const file::Json json = file::Json::parse(line, nullptr, false);
    const auto refuse = [&](const std::string& why) {
      throw InputError({.file = journal.string(), .line = number + 1, .field = {}}, why);
    };
    if (!json.is_object()) {
      refuse("is no line of a journal");
    }
    if (number++ == 0) {
      continue;  // what the journal is of
    }
    const file::Json result = json.value("result", file::Json::object());
    const file::Json seconds =
        result.is_object() ? result.value("seconds", file::Json()) : file::Json();
    if (!seconds.is_number() || !(seconds.get<double>() >= 0.0)) {
      refuse("has no result with its time, `seconds`");
    }
    times.seconds.push_back(seconds.get<double>());
  }
  require(!times.seconds.empty(), journal.string(), "a journal with results");
  times.source = fmt::format("{} jobs of {}", times.seconds.size(), times.source);
  return times;
}

FleetTimes draw_fleet_times(const FleetTimes& from, std::size_t count) {
  FleetTimes times{fmt::format("{} jobs drawn from {}", count, from.source), {}};
  RandomStream random(1, "fleet times");
  for (std::size_t i = 0; i < count; ++i) {
    times.seconds.push_back(from.seconds[random.below(from.seconds.size())]);
  }
  return times;
}

FleetTimes lognormal_fleet_times(double median_s, double sigma, std::size_t count) {
  FleetTimes times{
      fmt::format("{} jobs, lognormal: median {:g} s, sigma {:g}", count, median_s, sigma), {}};
  RandomStream random(1, "fleet times");
  for (std::size_t i = 0; i < count; ++i) {
    times.seconds.push_back(median_s * std::exp(sigma * random.normal()));
  }
  return times;
}

std::vector<FleetSchedule> fleet_schedules(const FleetTimes& times,
                                           const std::vector<std::size_t>& ranks,
                                           jobs::ScheduleSettings settings) {
  std::vector<double> sorted = times.seconds;
  std::ranges::sort(sorted, std::greater{});
  std::vector<FleetSchedule> schedules;
  for (const std::size_t count : ranks) {
    settings.ranks = count;
    schedules.push_back({settings, jobs::simulate_schedule(sorted, settings),
                         jobs::simulate_schedule(times.seconds, settings)});
  }
  return schedules;
}

}  // namespace kelpie::lab
