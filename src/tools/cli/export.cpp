// SPDX-License-Identifier: Apache-2.0

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "cli/output.hpp"
#include "file/atomic_file.hpp"
#include "fmu/fmu_file.hpp"
#include "format/live_library.hpp"
#include "format/model_c.hpp"
#include "format/settings_file.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/model/trained_model.hpp"
#include "model/snapshot.hpp"

namespace kelpie::cli {
namespace {

struct ExportArguments {
  std::string model;
  std::string fmu;
  std::string c_file;
  std::string live;
  std::string header;
  std::vector<std::string> units;
  format::CodeOptions code;
};

std::map<std::string, Unit> given_units(const ExportArguments& options) {
  std::map<std::string, Unit> units;
  for (const std::string& assignment : options.units) {
    const auto [column, unit] = format::key_and_value(assignment, "--units");
    units[column] = Unit::parse(unit);
  }
  return units;
}

// With the units given, and else the model's own.
format::CodeOptions code_options(const ExportArguments& options, const format::ModelInfo& info,
                                 std::map<std::string, Unit> units) {
  format::CodeOptions code = options.code;
  code.source = options.model;
  code.units = std::move(units);
  for (const auto& [column, text] : info.units) {
    code.units.try_emplace(column, Unit::parse(text));
  }
  return code;
}

void tell_c(const TrainedModel& model, const ExportArguments& options,
            const format::CodeOptions& code) {
  say("C: {} ({} inputs, {} predictions, {})\n", options.c_file, model.input_names.size(),
      model.axes.size(), code.single ? "float" : "double");
  say("{:.0f} kB of constants, no memory but the stack\n",
      static_cast<double>(format::table_bytes(model, code)) / 1000.0);
}

void export_live(const TrainedModel& model, const format::LiveFiles& files,
                 const format::CodeOptions& code) {
  format::write_live_library(files, model, code);
  // Loaders look for a name without a folder elsewhere.
  const std::filesystem::path loaded =
      files.library.has_parent_path() ? files.library : "." / files.library;
  say("library: {} (for CasADi: external(\"{}\", \"{}\"))\nblock:   {} (kelpie live --block {})\n"
      "source:  {}\n",
      files.library.string(), code.name, loaded.string(), files.block.string(),
      files.block.string(), files.source.string());
}

std::string header_text(const TrainedModel& model, const ExportArguments& options,
                        format::CodeOptions code) {
  if (!options.live.empty()) {
    code.live = {.file = {}, .layout = {}};  // prototypes need neither
  }
  return format::model_h(model, code);
}

// Every file but those of --live, by path; nothing is written before all have a content.
std::map<std::string, std::string> contents(const TrainedModel& model,
                                            const ExportArguments& options,
                                            const format::CodeOptions& code) {
  std::map<std::string, std::string> files;
  if (!options.c_file.empty()) {
    files[options.c_file] = format::model_c(model, code);
  }
  if (!options.header.empty()) {
    files[options.header] = header_text(model, options, code);
  }
  if (!options.fmu.empty()) {
    files[options.fmu] = fmu::fmu_content(model, {.name = code.name, .units = code.units});
  }
  return files;
}

void check_outputs(const ExportArguments& options) {
  std::vector<std::pair<const char*, std::string>> outputs{
      {"--c", options.c_file}, {"--header", options.header}, {"--fmu", options.fmu}};
  if (!options.live.empty()) {
    const format::LiveFiles live(options.live);
    for (const std::filesystem::path& file : {live.library, live.block, live.source}) {
      outputs.emplace_back("--live", file.string());
    }
  }
  std::vector<std::string> taken{options.model};
  for (const auto& [option, name] : outputs) {
    if (!name.empty()) {
      check_output(option, name, taken);
      taken.push_back(name);
    }
  }
}

// What of C is asked for has to be written.
void check_wishes(const ExportArguments& options) {
  if (options.c_file.empty() && options.live.empty() && options.fmu.empty()) {
    throw InputError("export", "needs --c FILE, --live FILE or --fmu FILE: what to write");
  }
  if (!options.c_file.empty() || !options.live.empty()) {
    return;
  }
  const auto wishes =
      std::to_array<std::pair<const char*, bool>>({{"--header", !options.header.empty()},
                                                   {"--float", options.code.single},
                                                   {"--assess", options.code.assess},
                                                   {"--hessian", options.code.hessian},
                                                   {"--casadi", options.code.casadi}});
  for (const auto& [option, is_given] : wishes) {
    require(!is_given, option, "needs --c FILE or --live FILE");
  }
}

void export_model(const ExportArguments& options) {
  check_wishes(options);
  check_outputs(options);
  std::map<std::string, Unit> units = given_units(options);
  format::ModelInfo info;
  const TrainedModel model = read_given_model(options.model, &info);
  const format::CodeOptions code = code_options(options, info, std::move(units));
  const std::map<std::string, std::string> files = contents(model, options, code);
  if (!options.live.empty()) {
    export_live(model, format::LiveFiles(options.live), code);
  }
  for (const auto& [file, content] : files) {
    file::write_file_whole(file, content);
  }
  if (!options.c_file.empty()) {
    tell_c(model, options, code);
  }
  if (!options.fmu.empty()) {
    say("FMU: {} (FMI 2.0, co-simulation, this machine's processor)\n", options.fmu);
  }
}

}  // namespace

void add_export(CLI::App& app) {
  const auto [command, options] = add_command(app, "export",
                                              "Write a learned model for other programs: as C, as "
                                              "a library that follows the learner, or as "
                                              "a unit of FMI 2.0",
                                              export_model);
  add_model(command, "model", options->model);
  add_file(command, "--c", options->c_file, "C file to write: C99 that needs nothing but exp()");
  add_file(command, "--live", options->live,
           "shared library to write, with CasADi's functions, by the machine's C compiler; its "
           "numbers are in a block beside it, FILE with the ending .block, which `kelpie live "
           "--block` renews");
  add_file(command, "--header", options->header, "header file to write for callers");
  add_file(command, "--fmu", options->fmu,
           "co-simulation unit of FMI 2.0 to write: the vehicle in simulation");
  command->add_flag("--float", options->code.single, "float instead of double");
  command->add_flag("--assess", options->code.assess,
                    "a function that tells interval and novelty, too");
  command->add_flag("--hessian", options->code.hessian,
                    "functions that tell second derivatives, too");
  command->add_flag("--casadi", options->code.casadi,
                    "the functions that CasADi's external() and acados call, too, and those of "
                    "--hessian");
  command
      ->add_option("--name", options->code.name,
                   "beginning of the functions' names; name of the unit of FMI")
      ->capture_default_str();
  add_list(command, "--units", options->units,
           "units of columns, kept in the file, as in u=m/s,th1=rev/s,udot=m/s^2");
  add_examples(command, "export --c model.c --header model.h",
               "export out/learn/model.json --live vehicle.so");
}

}  // namespace kelpie::cli
