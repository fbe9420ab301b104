// SPDX-License-Identifier: Apache-2.0
#include "lab/commands.hpp"

#include <system_error>

#include "cli/output.hpp"
#include "file/atomic_file.hpp"
#include "log/read_log.hpp"
#include "simulator/simulation.hpp"
#include "study/simulated_log.hpp"

namespace kelpie::lab {

void add_run_options(CLI::App* command, std::uint64_t& seed, std::size_t& threads, std::string& out,
                     const std::string& files) {
  cli::add_seed(command, seed, "the first of them");
  cli::add_threads(command, threads);
  cli::add_out(command, out, "folder for " + files);
}

void add_seeds(CLI::App* command, std::size_t& seeds, const std::string& meaning) {
  command->add_option("--seeds", seeds, meaning)->check(CLI::PositiveNumber)->capture_default_str();
}

void StudiedLog::add_to(CLI::App& command) {
  log.add_to(command);
  command.get_option("log")->required(false);
  cli::add_file(&command, "--config", config, "TOML file with the columns of the log in [log]");
}

log::Dataset StudiedLog::read(const std::optional<std::string>& held_out) const {
  const log::LogConfig file = log::read_log_config(config);
  log::Roles roles = log.over(file.roles);
  roles.held_out = held_out.value_or(roles.held_out);
  return cli::open_log(log.source, file, roles).dataset();
}

log::Dataset simulated_log(const simulator::Scenario& scenario, const std::string& source) {
  const log::Table table = study::log_table(simulator::simulate(scenario), source);
  return log::make_dataset(table, log::guess_roles(table, {}));
}

file::OutFolder StudyOutput::take() const {
  return cli::take_out_folder(folder, {name + ".html", name + ".json"}, inputs);
}

void StudyOutput::write(const file::OutFolder& taken, const StudyReport& report) const {
  const std::string numbers = (taken.path() / (name + ".json")).string();
  if (report.html.empty()) {
    file::write_files_whole(taken.path(), {{name + ".json", report.json}});
    cli::say("{}numbers: {}\npicture: lab/plot.py {}\n", report.table, numbers, numbers);
  } else {
    file::FileSet files{{name + ".html", report.html}, {name + ".json", report.json}};
    if (!report.markdown.empty()) {
      files[name + ".md"] = report.markdown;
    }
    file::write_files_whole(taken.path(), files);
    cli::say("{}page:    {}\nnumbers: {}\n", report.table,
             (taken.path() / (name + ".html")).string(), numbers);
  }
}

namespace fs = std::filesystem;

fs::path scenario_folder() {
  std::error_code none;
  const fs::path program = fs::read_symlink("/proc/self/exe", none).parent_path();
  for (const fs::path& folder :
       {fs::path("scenarios"), program / KELPIE_DATA_FROM_PROGRAM / "scenarios",
        program / "../../scenarios"}) {
    if (fs::is_directory(folder, none)) {
      return folder.lexically_normal();
    }
  }
  throw InputError("--scenarios",
                   "there is no folder 'scenarios' here or with the program; name one");
}

std::string scenario_file(const std::string& file, const char* name) {
  return file.empty() ? (scenario_folder() / name).string() : file;
}

}  // namespace kelpie::lab
