// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "cli/log_options.hpp"
#include "cli/options.hpp"
#include "cli/output.hpp"
#include "cli/six_axis_log.hpp"
#include "cli/tuning.hpp"
#include "core/text.hpp"
#include "file/atomic_file.hpp"
#include "format/certificate_json.hpp"
#include "format/identified_vehicle.hpp"
#include "format/parameters.hpp"
#include "kelpie/core/error.hpp"
#include "report/identification_report.hpp"
#include "report/verdicts.hpp"
#include "simulator/scenario_file.hpp"
#include "study/alignment.hpp"
#include "study/identification.hpp"

namespace kelpie::cli {
namespace {

constexpr const char* kYaml = "parameters.yaml";
constexpr const char* kPage = "identify.html";
constexpr const char* kCertificate = "certificate.json";
constexpr const char* kOwn = "kelpie";

using Base = std::optional<simulator::VehicleParameters>;

// What is written for a simulator.
struct EngineFile {
  const char* engine;  // of --for, and of the certificate where one of that name is
  const char* file;
  std::string (*text)(const format::IdentifiedVehicle&, const std::string& source);
};

constexpr std::array kEngineFiles{
    EngineFile{kOwn, "vehicle.toml", format::vehicle_toml},
    EngineFile{"gazebo", "gazebo.sdf", format::gazebo_sdf},
    EngineFile{"gazebo_plugin", "gazebo_plugin.sdf", format::gazebo_plugin_sdf},
    EngineFile{"uuv_simulator", "uuv_simulator.xacro", format::uuv_xacro},
    EngineFile{"stonefish", "stonefish.xml", format::stonefish_xml},
    EngineFile{"mss", "mss.m", format::mss_m},
    EngineFile{"python_vehicle_simulator", "python_vehicle.py", format::python_vehicle}};

struct IdentifyArguments : IdentificationOptions {
  std::optional<double> mass_kg;
  std::optional<double> surge_added_mass_kg;
  SixAxisOptions six;
  std::string out = "out/identify";
  std::vector<std::string> engines;
  AnswerOptions answer;
};

study::KnownThrust known_thrust(const IdentifyArguments& options, const Base& base) {
  study::KnownThrust wish{.mass_kg = options.mass_kg,
                          .surge_added_mass_kg = options.surge_added_mass_kg};
  wish.thrust = known_thrusts(options.thrust);
  if (base) {
    if (!wish.mass_kg) {
      wish.mass_kg = base->mass_kg;
    }
    if (!wish.surge_added_mass_kg && wish.thrust.empty()) {
      wish.surge_added_mass_kg = base->added_mass(0, 0);
      wish.is_of_vehicle_file = true;
    }
  }
  if (options.surge_added_mass_kg && !wish.mass_kg) {
    throw InputError("--surge-added-mass", "needs --mass, the rigid body's");
  }
  return wish;
}

std::vector<std::string> all_files() {
  std::vector<std::string> names{kYaml, kPage, kCertificate};
  for (const EngineFile& one : kEngineFiles) {
    names.emplace_back(one.file);
  }
  return names;
}

// The files of --for, all without the option. Throws InputError on another name.
std::vector<EngineFile> wanted_files(const std::vector<std::string>& engines) {
  std::vector<std::string> known;
  for (const EngineFile& one : kEngineFiles) {
    known.emplace_back(one.engine);
  }
  for (const std::string& engine : engines) {
    require_name("--for", engine, "simulator", known);
  }
  std::vector<EngineFile> wanted;
  std::ranges::copy_if(kEngineFiles, std::back_inserter(wanted), [&](const EngineFile& one) {
    return engines.empty() || std::ranges::find(engines, one.engine) != engines.end();
  });
  return wanted;
}

// The project's own simulator takes certain vehicles only; the reason is said.
bool is_for_own_simulator(const format::IdentifiedVehicle& vehicle, const char* file) {
  if (!vehicle.has_slots) {
    warn("no {}: kelpie's simulator has two thrusters along surge and one along sway\n", file);
    return false;
  }
  try {
    vehicle.body.validate();
  } catch (const InputError& error) {
    warn("no {}: {}\n", file, error.what());
    return false;
  }
  return true;
}

// Simulators' files where forces have a scale.
void add_simulators(const study::Identification& found, const format::IdentifiedVehicle& vehicle,
                    const std::vector<EngineFile>& wanted, file::FileSet& files) {
  for (const EngineFile& one : wanted) {
    if (one.engine != kOwn || is_for_own_simulator(vehicle, one.file)) {
      files[one.file] = one.text(vehicle, found.source);
    }
  }
}

// The certificates of the wanted simulators, the project's own equations first.
study::CertificateList certificates_of(const format::IdentifiedVehicle& vehicle,
                                       const study::RecordedDrive& drive,
                                       const std::vector<EngineFile>& wanted) {
  std::vector<simulator::Engine> engines;
  std::ranges::copy_if(
      simulator::engines(), std::back_inserter(engines), [&](const simulator::Engine& engine) {
        return engine.name == kOwn || std::ranges::any_of(wanted, [&](const EngineFile& one) {
                 return engine.name == one.engine;
               });
      });
  return study::certify(engines, simulator::engine_body(vehicle.body, vehicle.identified), drive);
}

// An identification with what its files need.
struct Identified {
  study::Identification found;
  Frame frame = Frame::flu;
  std::optional<format::IdentifiedVehicle> vehicle{};
  study::RecordedDrive drive{};
};

// On six axes, where the vehicle file has the thrusters of the log; else nothing, with the reason.
std::optional<Identified> on_six_axes(const IdentifyArguments& options,
                                      const study::KnownThrust& wish,
                                      const simulator::VehicleParameters& vehicle,
                                      std::string& why) {
  const std::optional<SixAxisLog> log = six_axis_log(options, options.six, vehicle, why);
  if (!log) {
    return std::nullopt;
  }
  study::KnownThrust known = wish;
  known.thrust = of_full_commands(wish.thrust, vehicle);
  const study::LearnPlan& plan = log->plan;
  Identified result{.found = {}, .frame = log->frame};
  result.found = study::identify_six_axes(plan.data, plan.split, log->columns, vehicle, log->frame,
                                          log->neutral, known, options.only, log->how);
  result.found.alignment = log->how.find_times
                               ? "lag and delay of the thrusters are found with the rest"
                               : "thrusters follow their commands at once, as asked";
  if (result.found.scale != study::ScaleSource::none) {
    result.vehicle = format::identified_on_six_axes(result.found, vehicle, options.six.vehicle);
    result.drive =
        format::recorded_drive(*result.vehicle, result.found, plan.data, plan.split, log->columns,
                               vehicle, result.frame, log->neutral, options.only);
  }
  return result;
}

Identified in_plane(const IdentifyArguments& options, const study::KnownThrust& wish,
                    const Base& base) {
  PlanOptions wanted = options;
  wanted.with_lags = true;
  wanted.check_targets = false;  // study::identify() does
  wanted.log.source.with_poses = true;
  const study::LearnPlan log = plan_log(wanted).plan;
  const study::PlanarColumns columns =
      study::planar_columns(log.data, log.settings.shared.states, options.thrusters);
  Identified result{.found = study::identify(log.data, log.split, columns, wish, options.only,
                                             !options.accept.empty()),
                    .frame = body_frame(options.six.frame, false)};
  result.found.alignment = study::alignment_text(log.alignment, log.data.rate_hz);
  result.found.lags = log.lags;
  if (result.found.scale != study::ScaleSource::none) {
    result.vehicle =
        format::identified_vehicle(result.found, result.frame, base, options.six.vehicle);
    result.drive = format::recorded_drive(*result.vehicle, log.data, log.split,
                                          format::drive_columns(columns, result.found),
                                          result.frame, options.only);
  }
  return result;
}

Identified identified(const IdentifyArguments& options, const study::KnownThrust& wish,
                      const Base& base) {
  if (base && !simulator::drives_in_plane(*base)) {
    std::string why;
    if (std::optional<Identified> six = on_six_axes(options, wish, *base, why)) {
      return *std::move(six);
    }
    warn("in the plane, not on six axes: {}\n", why);
  }
  refuse_volts_in_plane(options.six);
  return in_plane(options, wish, base);
}

file::FileSet files_of(const Identified& result, const std::vector<EngineFile>& wanted) {
  file::FileSet files;
  for (const std::string& name : all_files()) {
    files[name] = std::nullopt;
  }
  if (result.vehicle) {
    add_simulators(result.found, *result.vehicle, wanted, files);
    files[kCertificate] = format::certificate_json(result.found.certificates, result.found.source);
  }
  files[kYaml] = format::parameters_yaml(result.found, result.frame);
  files[kPage] = report::identification_html(result.found);
  return files;
}

// The log and the options of `identify`.
std::string again_text(const IdentifyArguments& options) {
  const std::string engines = join_text(options.engines, ",");
  return options.logs_text() + identification_text(options, options.six) +
         (engines.empty() ? "" : " --for " + shell_word(engines));
}

// Worse than the mean of the held-out rows on some axis: no vehicle for a simulator.
std::string failure_of(const study::Identification& found) {
  const std::vector<double>& r2 = found.held_out.r2;
  const auto worst = std::ranges::min_element(r2);
  if (found.held_out.times_s.empty() || worst == r2.end() || !(*worst < 0.0)) {
    return "";
  }
  return fmt::format(
      "no vehicle was identified: R² of {} is {:.3g} on held-out rows, and the mean "
      "of these rows has 0; no files for simulators are written. Are the commands, "
      "units and axes right? --accept implausible writes the files",
      found.targets[static_cast<std::size_t>(worst - r2.begin())], *worst);
}

void run_identify(const IdentifyArguments& given) {
  given.answer.begin();
  IdentifyArguments options = given;
  begin_six_axes(options.six, options);
  const Base base =
      options.six.vehicle.empty() ? Base() : Base(simulator::read_vehicle(options.six.vehicle));
  const study::KnownThrust wish = known_thrust(options, base);
  const std::vector<EngineFile> wanted = wanted_files(options.engines);
  std::vector<std::string> inputs = options.files();
  inputs.push_back(options.six.vehicle);
  const file::OutFolder out = take_out_folder(options.out, all_files(), inputs);
  Identified result = identified(options, wish, base);
  const std::string failure = options.accept.empty() ? failure_of(result.found) : "";
  if (!failure.empty()) {
    result.vehicle.reset();
  }
  if (result.vehicle) {
    result.found.certificates = certificates_of(*result.vehicle, result.drive, wanted);
  }
  const file::FileSet files = files_of(result, wanted);
  file::write_files_whole(out.path(), files);
  if (!failure.empty()) {
    throw InputError({.file = result.found.source}, failure);
  }
  Answer answer{
      .verdict = report::identification_verdict(result.found),
      .tables = report::identification_table(result.found),
      .document = options.answer.json ? format::parameters_json(result.found, result.frame) : "",
      .files = {},
      .next = {}};
  answer.add_files(files, out.path());
  answer.next = {result.found.scale == study::ScaleSource::none
                     ? fmt::format("kelpie identify {} --mass KG   (masses and forces, not ratios)",
                                   again_text(given))
                     : "kelpie simulate SCENARIO.toml --out log.csv   "
                       "(docs/reference/simulator.md)"};
  give(answer, options.answer);
}

}  // namespace

void add_identify(CLI::App& app) {
  const auto [command, options] = add_command(
      app, "identify", "Estimate masses, drags and thrusts of a vehicle from a log, for simulators",
      run_identify);
  add_identification_options(*command, *options);
  add_split_option(*command, options->split, "held-out rows, which judge (see `learn`)");
  command->add_option("--mass", options->mass_kg, "of the vehicle with the water in it [kg]")
      ->check(within(kTuning.lightest_kg, kTuning.heaviest_kg));
  command
      ->add_option("--surge-added-mass", options->surge_added_mass_kg,
                   "gives the scale together with the mass [kg]; else assumed, 0.2 of it")
      ->check(within(kTuning.lightest_kg, kTuning.heaviest_kg))
      ->excludes(command->get_option("--thrust"));
  add_file(
      command, "--vehicle", options->six.vehicle,
      "vehicle file (docs/reference/simulator.md): with the places of the log's thrusters all six "
      "axes are identified, else it tells what the plane doesn't show; its mass, and without "
      "--thrust "
      "its added mass in surge, give the scale");
  command->add_option("--volts", options->six.volts,
                      "column with the supply of the thrusters in V, for six axes");
  add_frame_option(*command, options->six.frame);
  add_list(command, "--for", options->engines,
           "simulators to write for, separated by commas; else all: kelpie, gazebo, gazebo_plugin, "
           "uuv_simulator, stonefish, mss, python_vehicle_simulator");
  add_seed(command, options->seed);
  add_out(command, options->out, "folder for the parameters and files of simulators");
  options->answer.add_to(*command, "the parameters as JSON");
  add_examples(
      command, "identify dive.csv --rate 4 --units th1=rev/s,th2=rev/s,th3=rev/s",
      "identify dive.BIN --vehicle vehicles/bluerov2_heavy.toml --volts voltage --for gazebo");
}

}  // namespace kelpie::cli
