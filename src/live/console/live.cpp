// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "autopilot/vehicle_configuration.hpp"
#include "bag/open_bag.hpp"
#include "cli/interrupt.hpp"
#include "cli/log_options.hpp"
#include "cli/options.hpp"
#include "cli/output.hpp"
#include "console/commands.hpp"
#include "console/demo.hpp"
#include "console/live_console.hpp"
#include "console/live_signals.hpp"
#include "console/live_transport.hpp"
#include "console/service.hpp"
#include "core/text.hpp"
#include "file/atomic_file.hpp"
#include "file/out_folder.hpp"
#include "file/toml.hpp"
#include "format/checkpoint_file.hpp"
#include "kelpie/core/error.hpp"
#include "live/checkpoint.hpp"
#include "live/configuration.hpp"
#include "live/engine.hpp"
#include "live/plotjuggler.hpp"
#include "live/recorder.hpp"
#include "live/replay.hpp"
#include "log/log_config.hpp"
#include "log/read_log.hpp"

namespace kelpie::cli {
namespace {

constexpr const char* kDemoPage = "8080";
constexpr const char* kDemoFolder = "out/demo";
constexpr const char* kVehicleFile = "vehicle.toml";  // what a vehicle told
constexpr const char* kAllParameters = "all";
constexpr double kShortestDemoS = 20.0;
constexpr double kLongestDemoS = 86'400.0;

struct LiveArguments {
  std::string config;
  std::vector<std::string> set;
  LogOptions log;  // to be replayed
  bool demo = false;
  double duration_s = 600.0;  // of the demonstration
  std::string speed = "1";
  std::string out;
  std::string record;
  std::string nominal;
  std::string block;
  std::string plotjuggler;
  std::string page;
  std::vector<std::string> tell;  // parameters; empty: as the file says
  std::vector<std::string> thrust;
  double percent = 0.0;  // 0: the file's
  std::string mavlink;   // connection of a vehicle that tells what its messages mean
  std::string told{};    // by the vehicle: a configuration
  bool fresh = false;
  bool freeze = false;
  bool resume = false;
  bool check = false;
};

// A table, whose rows are read as `kelpie learn` reads them.
live::Configuration rows_configuration(const LiveArguments& options) {
  const log::LogConfig config = log::read_log_config(options.config);
  return live::rows_configuration(
      new_dataset(open_log(options.log.source, config, options.log.over(config.roles))),
      options.config, options.set);
}

// Columns are those of a table: of no connection, recording or demonstration.
void check_columns(const LiveArguments& options) {
  const std::string& replay = options.log.source.path;
  if (options.log.has_columns() &&
      (!options.mavlink.empty() || options.demo || replay.empty() || bag::is_bag(replay))) {
    throw InputError("--inputs, --targets, --ignore, --time, --rate, --units, --pose",
                     "say what the columns of a CSV file are; [log] of --config says what "
                     "messages mean");
  }
}

live::Configuration read_configuration(const LiveArguments& options) {
  const log::LogSource& replay = options.log.source;
  if (!options.told.empty()) {
    const std::string name = "the configuration of the vehicle at " + options.mavlink;
    return live::read_configuration(file::TomlNode::parse(options.told, name), name, options.set);
  }
  if (options.demo) {
    return demo_configuration(options.duration_s, options.config, options.set);
  }
  if (!replay.path.empty() && !bag::is_bag(replay.path)) {
    return rows_configuration(options);
  }
  if (options.config.empty() && replay.path.empty()) {
    throw InputError(
        "--config",
        "is missing: what the messages of a connection mean, for which `kelpie inspect "
        "LOG --template` writes a draft; a vehicle with ArduSub needs none: --mavlink udp:14550; "
        "nor does a recording: --replay LOG; --demo shows a simulated vehicle");
  }
  std::string summary;
  live::Configuration configuration = options.config.empty()
                                          ? live::draft_configuration(replay, options.set, summary)
                                          : live::read_configuration(options.config, options.set);
  say("{}", summary);
  return configuration;
}

void add_parameters(const LiveArguments& options,
                    std::optional<live::ParameterSettings>& parameters) {
  if (options.tell.empty()) {
    return;
  }
  live::ParameterSettings& settings = parameters ? *parameters : parameters.emplace();
  settings.tell = options.tell == std::vector<std::string>{kAllParameters}
                      ? std::vector<std::string>{}
                      : options.tell;
  settings.thrust = options.thrust.empty() ? settings.thrust : known_thrusts(options.thrust);
  settings.percent = options.percent > 0.0 ? options.percent : settings.percent;
}

// The file's, with the options over it.
live::Configuration configuration_of(const LiveArguments& options) {
  live::Configuration configuration = read_configuration(options);
  live::LiveSettings& settings = configuration.live;
  if (!options.log.source.definitions.empty()) {
    configuration.log.messages = options.log.source.definitions;
  }
  settings.out = options.demo ? kDemoFolder : settings.out;
  settings.page = options.demo && has_pages() ? kDemoPage : settings.page;
  settings.out = options.out.empty() ? settings.out : options.out;
  settings.record = options.record.empty() ? settings.record : options.record;
  settings.nominal = options.nominal.empty() ? settings.nominal : options.nominal;
  settings.block = options.block.empty() ? settings.block : options.block;
  if (!options.plotjuggler.empty()) {
    live::parse_endpoint(options.plotjuggler, "--plotjuggler");
    settings.plotjuggler = options.plotjuggler;
  }
  if (!options.page.empty()) {
    live::parse_endpoint(options.page, "--page");
    settings.page = options.page;
  }
  add_parameters(options, settings.parameters);
  return configuration;
}

std::vector<std::unique_ptr<live::Output>> outputs_of(const live::Configuration& configuration) {
  std::vector<std::unique_ptr<live::Output>> outputs;
  outputs.push_back(std::make_unique<LiveConsole>(configuration.live.status_s));
  if (!configuration.live.plotjuggler.empty()) {
    outputs.push_back(std::make_unique<live::PlotJuggler>(
        live::parse_endpoint(configuration.live.plotjuggler, "plotjuggler"),
        configuration.plan.inputs, configuration.plan.targets));
  }
  return outputs;
}

std::unique_ptr<live::Recorder> recorder_of(const live::Configuration& configuration) {
  return configuration.live.record.empty()
             ? nullptr
             : std::make_unique<live::Recorder>(configuration.live.record,
                                                configuration.log.messages);
}

// The first thing that can't change while it runs.
std::string fixed_difference(const live::Configuration& now, const live::Configuration& next) {
  const auto differing = [](const live::Fields& a, const live::Fields& b) {
    const auto [in_a, in_b] = std::ranges::mismatch(a, b);
    return in_a != a.end() ? in_a->first : in_b != b.end() ? in_b->first : std::string();
  };
  const std::string field = differing(now.identity(), next.identity());
  if (!field.empty() || now.live.out != next.live.out) {
    return field.empty() ? "live.out" : field;
  }
  const bool same_page = now.live.page == next.live.page && now.live.token == next.live.token;
  return now.live.block != next.live.block       ? "live.block"
         : now.live.nominal != next.live.nominal ? "live.nominal"
         : !same_page                            ? "live.page"
         : !connects_alike(now, next)            ? "the connection"
                                      : differing(now.settings.values(), next.settings.values());
}

// What may change while it runs: the outputs, and how often.
class LiveRun {
 public:
  LiveRun(const LiveArguments& options, live::Configuration configuration)
      : options_(options), configuration_(std::move(configuration)), current_(configuration_) {}

  const live::Configuration& configuration() const { return configuration_; }

  void run(live::Transport& transport, std::optional<live::SavedRun> saved) {
    const InterruptGuard interrupt;
    const LiveSignals signals;
    page_ = page_of(configuration_, requests_);
    if (page_) {
      outputs_.add(*page_);
    }
    outputs_.use(outputs_of(current_));
    if (live::Output* const output = transport.open_output(requests_)) {
      outputs_.add(*output);
    }
    live::Engine engine(configuration_, configuration_.live.out, transport, std::move(saved),
                        outputs_, requests_);
    engine.record(recorder_of(current_));
    if (options_.freeze || options_.resume) {
      requests_.push(options_.freeze ? live::Request::freeze : live::Request::resume);
    }
    service_.ready();
    engine.run([&] {
      if (LiveSignals::asked_to_reload()) {
        reload(engine);
      }
      if (const std::optional<live::Request> request = LiveSignals::asked_for()) {
        requests_.push(*request);
      }
      if (engine.is_alive()) {
        service_.alive();
      }
      return InterruptGuard::asked() ? live::Engine::Action::stop : live::Engine::Action::proceed;
    });
    service_.stopping();
    outputs_.health(engine.health());  // what the last samples told
    outputs_.tell_left_out(live::EventLimit::Time::max());
    if (engine.has_ended()) {
      outputs_.ended();
    }
    outputs_.use({});
    finish(engine);
  }

 private:
  void reload(live::Engine& engine) {
    service_.reloading();
    try {
      live::Configuration next = configuration_of(options_);
      const std::string fixed = fixed_difference(configuration_, next);
      if (!fixed.empty()) {
        outputs_.event(fixed + " has changed; it takes effect at the next start");
      }
      std::vector<std::unique_ptr<live::Output>> outputs = outputs_of(next);
      if (next.live.record != current_.live.record) {
        engine.record(recorder_of(next));
      }
      engine.learner().set_checkpoint_s(next.live.checkpoint_s);
      outputs_.use(std::move(outputs));
      current_ = std::move(next);
      outputs_.event("the configuration was read anew");
    } catch (const std::exception& error) {
      outputs_.event(std::string("the configuration stays as it was: ") + error.what());
    }
    service_.ready();
  }

  void finish(live::Engine& engine) const {
    const live::Health health = engine.health();
    say("{}", final_table(health));
    const std::filesystem::path folder = configuration_.live.out;
    const bool has_model = engine.learner().model()->model().ready();
    say("model:      {}\ncheckpoint: {}\n",
        has_model ? (folder / "model.json").string() : "none: too few samples to learn from",
        (folder / format::kCheckpointName).string());
    if (!engine.has_ended()) {
      say("INTERRUPTED: the same command resumes the run\n");
    }
    if (!health.learner.checkpoint_error.empty()) {
      throw Failure("no checkpoint could be written: " + health.learner.checkpoint_error);
    }
  }

  const LiveArguments& options_;
  live::Configuration configuration_;  // that it began with
  live::Configuration current_;
  live::Requests requests_;
  std::unique_ptr<live::Output> page_;
  live::Outputs outputs_;
  Service service_;
};

std::optional<live::SavedRun> saved_run(const LiveArguments& options,
                                        const live::Configuration& configuration) {
  if (options.fresh || options.demo) {
    return std::nullopt;
  }
  try {
    std::optional<live::SavedRun> saved =
        live::find_checkpoint(configuration.live.out, configuration);
    if (saved && !saved->note.empty()) {
      warn("kelpie: {}; resuming from {}\n", saved->note, saved->file);
    }
    return saved;
  } catch (const InputError& error) {
    throw InputError(error.place(),
                     error.message() + "; --fresh begins anew, or give another --out");
  }
}

void say_plan(const live::Configuration& configuration,
              const std::optional<live::SavedRun>& saved) {
  const StreamPlan& plan = configuration.plan;
  say("inputs:  {}\ntargets: {}\nrate:    {} rows/s\n", join_text(plan.inputs, ", "),
      join_text(plan.targets, ", "), plan.rate_hz);
  if (plan.pose) {
    say("poses:   rows come {:.3g} s late, half of the window; until then velocities are "
        "reckoned\n",
        plan.pose->half_s);
  }
  for (const StreamPlan::Source& source : plan.sources) {
    say("{}: {}\n", source.name, source.from);
  }
  say("{}\n", saved ? fmt::format("resumes from {}: {} samples learned", saved->file,
                                  saved->progress.learned)
                    : "begins anew");
}

// Asks the vehicle what its messages mean.
LiveArguments with_told(LiveArguments options) {
  if (!options.mavlink.empty()) {
    const InterruptGuard interrupt;
    warn("kelpie: asking the vehicle at {} for its parameters\n", options.mavlink);
    std::string told;
    const autopilot::HeardVehicle heard =
        autopilot::hear_vehicle(options.mavlink, [&](const std::string& fault) {
          if (fault != told) {
            warn("{}", fault.empty() ? "" : "kelpie: " + fault + "\n");
            told = fault;
          }
          return !InterruptGuard::asked();
        });
    options.told = autopilot::configuration_text(options.mavlink, heard);
    const std::string others = log::other_outputs_text(heard.parameters);
    warn("{}", others.empty() ? "" : "kelpie: no thrusters, not taken: outputs " + others + "\n");
  }
  return options;
}

void live_command(const LiveArguments& given) {
  live::parse_speed(given.speed);
  check_columns(given);
  const LiveArguments options = with_told(given);
  const live::Configuration configuration = configuration_of(options);
  std::vector<std::string> written{"model.json", format::kCheckpointName,
                                   format::kPreviousCheckpointName};
  if (!options.told.empty()) {
    written.emplace_back(kVehicleFile);
  }
  const file::OutFolder folder =
      take_out_folder(configuration.live.out, written,
                      {options.log.source.path, options.config, configuration.live.nominal});
  if (!options.told.empty() && !options.check) {
    const std::filesystem::path file = std::filesystem::path(configuration.live.out) / kVehicleFile;
    file::write_file_whole(file, options.told);
    warn("kelpie: configuration: {}\n", file.string());
  }
  std::optional<live::SavedRun> saved = saved_run(options, configuration);
  const std::unique_ptr<live::Transport> transport =
      transport_of(options.log.source, options.speed, configuration, saved);
  if (options.check) {
    live::Outputs nobody;
    outputs_of(configuration);
    live::Requests nothing;
    page_of(configuration, nothing);
    const live::Engine checked(configuration, configuration.live.out, *transport, saved, nobody,
                               nothing);
    say_plan(configuration, saved);
    say("{}\n", join_text(transport->check(), "\n"));
    return;
  }
  if (saved) {
    warn("kelpie: resuming from {}, after {} samples\n", saved->file, saved->progress.learned);
  }
  LiveRun(options, configuration).run(*transport, std::move(saved));
}

CLI::Option* add_demo(CLI::App& command, LiveArguments& options) {
  CLI::Option* const demo = command.add_flag(
      "--demo", options.demo,
      "replay a simulated vehicle, one thruster of which loses 40 % of its thrust half-way; with a "
      "page at port 8080 and the folder out/demo, begun anew each time");
  command
      .add_option("--duration", options.duration_s,
                  "length of the demonstration, by the vehicle's clock [s]")
      ->check(within(kShortestDemoS, kLongestDemoS))
      ->capture_default_str()
      ->needs(demo);
  return demo;
}

void add_parameter_options(CLI::App& command, LiveArguments& options) {
  CLI::Option* const tell =
      add_list(&command, "--tell", options.tell,
               "parameters to identify while the vehicle drives, as of `kelpie plan`, or all; over "
               "live.parameters");
  add_list(&command, "--thrust", options.thrust,
           "gives the scale: NAME=K, forward thrust K n² in N (repeatable: the mean)")
      ->needs(tell);
  command.add_option("--percent", options.percent, "wanted half width of the 90 % intervals: 5")
      ->check(within(0.1, 100.0))
      ->needs(tell);
}

void add_outputs(CLI::App* command, LiveArguments& options) {
  add_folder(command, "--record", options.record,
             "folder for a recording of all that comes (MCAP), over live.record");
  add_file(command, "--nominal", options.nominal,
           "model.json of an earlier drive or of a like vehicle, with which a new model begins, "
           "over live.nominal");
  add_file(command, "--block", options.block,
           "block of `kelpie export --live` to renew with every learned row, over live.block");
  command->add_option("--plotjuggler", options.plotjuggler,
                      "port of PlotJuggler's UDP server on this machine, or host:port");
  command->add_option("--page", options.page,
                      "port of a page to look at and press buttons on, on this machine, or "
                      "host:port (docs/howto/live.md), over live.page");
}

}  // namespace

void add_live(CLI::App& app) {
  const auto [command, options] = add_command(
      app, "live", "Learn from messages as they come, and keep the model across restarts",
      live_command);
  add_file(command, "--config", options->config,
           "TOML file with [log], [live] and settings (docs/howto/live.md); without it a recording "
           "is read as `kelpie learn` reads one");
  add_set(command, options->set);
  CLI::Option* const mavlink =
      command
          ->add_option("--mavlink", options->mavlink,
                       "connection of a vehicle with ArduSub, in place of a configuration: "
                       "udp:14550, udpout:HOST:PORT or serial:DEVICE:BAUD; the vehicle's "
                       "parameters tell thrusters and directions (docs/howto/bluerov2.md)")
          ->excludes("--config");
  CLI::Option* const replay = add_file(command, "--replay", options->log.source.path,
                                       "log to replay, in place of a connection: " + log_formats());
  command
      ->add_option_function<std::string>(
          "--from",
          [options = options](const std::string& file) {
            warn(
                "kelpie: --from of `kelpie live` is called --replay; a later version takes --from "
                "for a model to go on from, as `kelpie learn` does\n");
            options->log.source.path = file;
          },
          "--replay, as it was called")
      ->group("")
      ->excludes(replay);
  mavlink->excludes(replay);
  add_demo(*command, *options)->excludes(replay)->excludes(mavlink);
  options->log.add_columns_to(*command);
  add_folder(command, "--msg-dir", options->log.source.definitions,
             "folder of .msg files, for types that the recording doesn't define");
  command
      ->add_option("--speed", options->speed,
                   "of the replay: times as quick as recorded, or max: as quick as it is learned")
      ->capture_default_str();
  add_folder(command, "--out", options->out,
             "folder for checkpoint and model.json, over live.out; a checkpoint there is gone "
             "on from");
  command->add_flag("--fresh", options->fresh, "begin anew, whatever checkpoint there is");
  CLI::Option* const freeze =
      command->add_flag("--freeze", options->freeze,
                        "predict, and learn nothing until resumed (as SIGUSR1 while it runs)");
  command
      ->add_flag("--resume", options->resume, "learn again, where learning was frozen (as SIGUSR2)")
      ->excludes(freeze);
  add_parameter_options(*command, *options);
  add_outputs(command, *options);
  command->add_flag("--check", options->check,
                    "say what the configuration makes of the messages, and don't start");
  add_examples(command, "live --config examples/bluerov.toml --page 8080",
               "live --demo --speed 10");
}

}  // namespace kelpie::cli
