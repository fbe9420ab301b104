// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.hpp"
#include "cli/log_options.hpp"
#include "cli/options.hpp"
#include "cli/output.hpp"
#include "cli/tuning.hpp"
#include "file/atomic_file.hpp"
#include "fleet/log_pattern.hpp"
#include "health/card.hpp"
#include "health/card_json.hpp"
#include "health/factors.hpp"
#include "health/gliders.hpp"
#include "kelpie/core/error.hpp"
#include "motion/states.hpp"
#include "report/health_report.hpp"

namespace kelpie::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHealthJson = "health.json";
constexpr const char* kHealthHtml = "health.html";
constexpr const char* kGlideEnding = "_glide.csv";

struct HealthArguments : PlanOptions {
  std::vector<std::string> logs;
  std::vector<std::string> since;  // NAME=DATE
  std::vector<std::string> dates;
  std::string depth;
  std::string volts;
  std::string density;
  std::vector<std::string> glider;  // NAME=COLUMN
  bool writes_glides = false;
  std::string out = "out/health";
  AnswerOptions answer;
};

// A log of a vehicle, before it is read.
struct Mission {
  std::string file;
  std::string name;
  double day = NAN;      // of the log's time 0, since 1970
  std::string glides{};  // file of its steady glides
};
using Fleet = std::map<std::string, std::vector<Mission>>;

Fleet find_logs(const HealthArguments& options) {
  Fleet fleet;
  std::size_t count = 0;
  const auto add = [&](const fs::path& file, const std::string& vehicle, std::string name) {
    if (name.empty()) {
      name = file.stem().string();
    }
    const double day = count < options.dates.size()
                           ? health::day_of(options.dates[count], "--dates")
                           : health::day_in_name(file.filename().string());
    fleet[vehicle.empty() ? "vehicle" : vehicle].push_back({file.string(), std::move(name), day});
    ++count;
  };
  for (const std::string& text : options.logs) {
    if (fs::exists(text) || text.find_first_of("*?[{") == std::string::npos) {
      add(text, "", "");
      continue;
    }
    std::vector<fleet::MatchedLog> found = fleet::LogPattern(text).find(fs::current_path());
    require(!found.empty(), "LOG", "'" + text + "' matches no file");
    std::ranges::sort(found, {}, &fleet::MatchedLog::file);
    for (const fleet::MatchedLog& log : found) {
      add(log.file, log.vehicle, log.mission);
    }
  }
  require(options.dates.empty() || options.dates.size() == count, "--dates",
          fmt::format("{} dates for {} logs", options.dates.size(), count));
  return fleet;
}

// Names the files of --glide-csv, each of its own. Returns the names.
std::vector<std::string> name_glides(Fleet& fleet) {
  std::map<std::string, std::string> logs;  // by the file of the glides
  std::vector<std::string> names;
  for (auto& [vehicle, missions] : fleet) {
    for (Mission& mission : missions) {
      mission.glides = (fleet.size() > 1 ? vehicle + "_" : "") + mission.name + kGlideEnding;
      const auto [taken, is_new] = logs.emplace(mission.glides, mission.file);
      require(is_new, "--glide-csv",
              fmt::format("would write the glides of {} and {} to one file, {}; give the logs "
                          "different names, or in different commands",
                          taken->second, mission.file, mission.glides));
      names.push_back(mission.glides);
    }
  }
  return names;
}

// The first log of a vehicle settles columns and alignment of all.
struct Reader {
  const HealthArguments& options;
  std::optional<PlannedLog> first{};

  log::Dataset read(const std::string& file) {
    PlanOptions one = options;
    one.log.source.path = file;
    one.split = "none";
    for (const std::string& slow : {options.depth, options.volts, options.density}) {
      if (!slow.empty()) {
        one.log.also.push_back(slow);
      }
    }
    if (!first) {
      first = plan_log(one);
      return first->plan.data;
    }
    const auto& [config, roles] = first->reading;
    const study::LearnPlan& plan = first->plan;
    log::Dataset data = open_log(one.log.source, config, roles).dataset();
    check_clock(data, options);
    check_targets(data, plan.settings.shared.states, options);
    AlignmentResult known = plan.alignment;
    known.alignment.water = {};
    return study::plan_learning(std::move(data), study::parse_split("none", 1), plan.settings,
                                one.align, known, false, one.current)
        .data;
  }
};

// Sets the days of the logs' time 0, from their first and last times [s], and returns whether they
// are dates. `are_given`: the missions' days are those of --dates, which go before stamps. Without
// dates, logs follow each other at once.
template <typename Log>
bool set_days(std::vector<Log>& logs, const std::vector<Mission>& missions,
              const std::vector<std::pair<double, double>>& times_s, bool are_given) {
  const bool in_stamps = std::ranges::all_of(
      times_s, [](const auto& times) { return times.first > kTuning.unix_time_s; });
  const bool is_dated = in_stamps || std::ranges::all_of(missions, [](const Mission& mission) {
                          return std::isfinite(mission.day);
                        });
  double end = 0.0;
  for (std::size_t i = 0; i < missions.size(); ++i) {
    const double first_day = times_s[i].first / health::kSecondsPerDay;
    // The stamps keep the time of day.
    logs[i].day = in_stamps  ? (are_given ? missions[i].day - std::floor(first_day) : 0.0)
                  : is_dated ? missions[i].day
                             : end - first_day;
    end = logs[i].day + times_s[i].second / health::kSecondsPerDay;
  }
  return is_dated;
}

std::vector<health::Baseline> baselines_of(const HealthArguments& options) {
  std::vector<health::Baseline> baselines;
  for (const std::string& text : options.since) {
    const std::size_t equals = text.find('=');
    require(equals != std::string::npos && equals > 0, "--since",
            "'" + text + "' is no NAME=DATE, as in cleaning=2026-03-03");
    baselines.push_back(
        {text.substr(0, equals), health::day_of(text.substr(equals + 1), "--since")});
  }
  return baselines;
}

health::HealthTable judge_drives(const HealthArguments& options,
                                 const std::vector<Mission>& missions, bool& is_dated) {
  Reader reader{options};
  std::vector<health::DriveLog> logs;
  std::vector<std::pair<double, double>> times_s;
  for (const Mission& mission : missions) {
    logs.push_back({.data = reader.read(mission.file), .mission = mission.name});
    times_s.emplace_back(logs.back().data.times_s.front(), logs.back().data.times_s.back());
  }
  is_dated = set_days(logs, missions, times_s, !options.dates.empty());
  const log::Dataset& first = logs.front().data;
  const health::DriveColumns columns{
      .velocities = find_states(reader.first->plan.settings.shared.states, first.input_names,
                                first.target_names.size()),
      .volts = options.volts,
      .density = options.density,
      .depth = options.depth};
  if (columns.velocities.empty()) {
    throw InputError({.file = first.source, .line = 0, .field = {}},
                     "no input is known as a velocity; name the velocities by --set "
                     "states=SURGE,SWAY,YAW, in the order of the targets");
  }
  return health::judge_drives(logs, columns);
}

// Brings a column of time stamps to seconds. Returns its first and last finite stamps [s], NAN
// where there is none.
std::pair<double, double> take_seconds(log::Table& table, std::size_t column) {
  const double unit_s = table.seconds_per_unit(column);
  std::pair<double, double> ends{NAN, NAN};
  for (double& value : table.columns[column]) {
    value *= unit_s;
    if (std::isfinite(value)) {
      ends = {std::isnan(ends.first) ? value : ends.first, value};
    }
  }
  if (unit_s != 1.0) {
    table.units[column] = "s";
  }
  return ends;
}

// `files`: gets the logs with the glider's speeds, where wanted.
health::HealthTable judge_gliders(const HealthArguments& options,
                                  const std::vector<Mission>& missions, bool& is_dated,
                                  file::FileSet& files) {
  const health::GliderColumns columns = health::glider_columns(options.glider);
  const log::LogConfig config = log::read_log_config(options.config);
  std::vector<health::GliderLog> logs;
  std::vector<std::pair<double, double>> times_s;
  for (const Mission& mission : missions) {
    log::Roles roles = options.log.over(config.roles);
    roles.inputs = health::columns_of(columns);
    roles.time = columns.time;
    log::LogSource source = options.log.source;
    source.path = mission.file;
    log::Table table = open_log(source, config, roles).table;
    require(table.rows() > 1, mission.file, "has fewer than two rows");
    times_s.push_back(take_seconds(table, table.find(columns.time)));
    logs.push_back({.table = std::move(table), .mission = mission.name});
  }
  is_dated = set_days(logs, missions, times_s, !options.dates.empty());
  std::vector<log::Table> glides;
  health::HealthTable judged =
      health::judge_gliders(logs, columns, options.writes_glides ? &glides : nullptr);
  for (std::size_t i = 0; i < glides.size(); ++i) {
    files[missions[i].glides] = log::csv_text(glides[i]);
  }
  return judged;
}

health::HealthCard card_of(const HealthArguments& options, const std::string& vehicle,
                           const std::vector<Mission>& missions,
                           const std::vector<health::Baseline>& baselines, file::FileSet& files) {
  bool is_dated = false;
  health::HealthTable table = options.glider.empty()
                                  ? judge_drives(options, missions, is_dated)
                                  : judge_gliders(options, missions, is_dated, files);
  require(is_dated || baselines.empty(), "--since",
          "needs the dates of the logs: in their names, in their stamps, or by --dates");
  return health::make_card(vehicle, is_dated, std::move(table), baselines);
}

void run_health(const HealthArguments& options) {
  options.answer.begin();
  const std::vector<health::Baseline> baselines = baselines_of(options);
  Fleet fleet = find_logs(options);
  require(!options.writes_glides || !options.glider.empty(), "--glide-csv", "needs --glider");
  require(options.glider.empty() || (options.log.inputs.empty() && options.log.targets.empty()),
          "--inputs, --targets", "say nothing of a glider's log, whose columns --glider names");
  std::vector<std::string> inputs{options.config};
  std::vector<std::string> names;
  if (options.writes_glides) {
    names = name_glides(fleet);
  }
  names.insert(names.end(), {kHealthJson, kHealthHtml});
  for (const auto& [vehicle, missions] : fleet) {
    for (const Mission& mission : missions) {
      inputs.push_back(mission.file);
    }
  }
  const file::OutFolder out = take_out_folder(options.out, names, inputs);
  std::vector<health::HealthCard> cards;
  file::FileSet files;
  for (const auto& [vehicle, missions] : fleet) {
    cards.push_back(card_of(options, vehicle, missions, baselines, files));
  }
  const std::string json = health::cards_json(cards);
  files[kHealthJson] = json;
  files[kHealthHtml] = report::health_html(cards);
  file::write_files_whole(out.path(), files);
  Answer answer{.verdict = report::health_verdict(cards),
                .tables = report::health_tables(cards),
                .document = options.answer.json ? json : "",
                .files = {},
                .next = {}};
  answer.add_files(files, out.path());
  give(answer, options.answer);
}

}  // namespace

void add_health(CLI::App& app) {
  const auto [command, options] = add_command(
      app, "health", "Tell what changed on a vehicle from dive to dive, since when and how fast",
      run_health);
  add_files(command, "logs", options->logs,
            "logs of one vehicle; or patterns as in study files, 'dives/{vehicle}/{mission}.csv'");
  command->get_option("logs")->required();
  options->log.add_columns_to(*command);
  add_file(command, "--config", options->config, "TOML configuration with [log] and settings");
  add_set(command, options->set);
  add_list(command, "--since", options->since,
           "days from which changes are counted anew, NAME=DATE: cleaning=2026-03-03");
  add_list(command, "--dates", options->dates,
           "days of the logs, in their order; else from the files' names or stamps");
  command->add_option("--depth", options->depth, "column with the depth: each dive by itself");
  command->add_option("--volts", options->volts, "column with the supply of the thrusters [V]");
  command->add_option("--density", options->density, "column with the water's density [kg/m³]");
  add_list(command, "--glider", options->glider,
           "columns of a glider's CSV logs, NAME=COLUMN with the names pitch, ballast, depth, "
           "sinking or speed, and as far as logged time, density, mass, roll, turn");
  command->add_flag("--glide-csv", options->writes_glides,
                    "write each glider's log with the speeds of steady gliding, for `learn`");
  add_align_option(*command, options->align);
  add_current_option(*command, *options);
  add_accept_option(*command, options->accept);
  add_out(command, options->out, "folder for health.json and health.html");
  options->answer.add_to(*command, kHealthJson);
  add_examples(command, "health dives/2026-*.csv --since cleaning=2026-03-03",
               "health 'dives/{vehicle}/{mission}.csv' --volts battery");
}

}  // namespace kelpie::cli
