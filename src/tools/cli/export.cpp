// SPDX-License-Identifier: Apache-2.0

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "cli/output.hpp"
#include "file/atomic_file.hpp"
#include "format/model_c.hpp"
#include "format/settings_file.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/model/trained_model.hpp"
#include "model/snapshot.hpp"

namespace kelpie::cli {
namespace {

struct ExportArguments {
  std::string model;
  std::string c_file;
  std::string header;
  std::vector<std::string> units;
  format::CodeOptions code;
};

void export_model(const ExportArguments& options) {
  check_output("--c", options.c_file, {options.model});
  if (!options.header.empty()) {
    check_output("--header", options.header, {options.model, options.c_file});
  }
  const TrainedModel model = read_given_model(options.model);
  format::CodeOptions code = options.code;
  code.source = options.model;
  for (const std::string& assignment : options.units) {
    const auto [column, unit] = format::key_and_value(assignment, "--units");
    code.units[column] = Unit::parse(unit);
  }
  file::write_file_whole(options.c_file, format::model_c(model, code));
  if (!options.header.empty()) {
    file::write_file_whole(options.header, format::model_h(model, code));
  }
  say("C: {} ({} inputs, {} predictions, {})\n", options.c_file, model.input_names.size(),
      model.axes.size(), code.single ? "float" : "double");
  say("{:.0f} kB of constants, no memory but the stack\n",
      static_cast<double>(format::table_bytes(model, code)) / 1000.0);
}

}  // namespace

void add_export(CLI::App& app) {
  const auto [command, options] =
      add_command(app, "export", "Write a learned model as C for other programs", export_model);
  add_model(command, "model", options->model);
  add_file(command, "--c", options->c_file, "C file to write: C99 that needs nothing but exp()")
      ->required();
  add_file(command, "--header", options->header, "header file to write for who calls it");
  command->add_flag("--float", options->code.single, "float instead of double");
  command->add_flag("--assess", options->code.assess,
                    "a function that tells interval and novelty, too");
  command->add_flag("--casadi", options->code.casadi,
                    "the functions that CasADi's external() and acados call, too");
  command->add_option("--name", options->code.name, "what the names of its functions begin with")
      ->capture_default_str();
  add_list(command, "--units", options->units,
           "units of columns, kept in the file, as in u=m/s,th1=rev/s,udot=m/s^2");
  add_examples(command, "export --c model.c --header model.h",
               "export out/tail/model.json --c model.c --float --assess");
}

}  // namespace kelpie::cli
