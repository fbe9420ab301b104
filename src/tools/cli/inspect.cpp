// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.hpp"
#include "cli/log_options.hpp"
#include "cli/options.hpp"
#include "cli/output.hpp"
#include "file/atomic_file.hpp"
#include "kelpie/core/error.hpp"
#include "log/draft.hpp"
#include "log/plausibility.hpp"
#include "log/read_log.hpp"
#include "report/inspect_report.hpp"
#include "study/first_look.hpp"

namespace kelpie::cli {
namespace {

struct InspectArguments {
  LogOptions log;
  std::string json;
  std::string draft;
};

// What `kelpie learn` would find of the log: mistakes, and whether commands and velocities belong
// together. Where the log cannot be learned as it is, says why.
struct LearnableLog {
  std::vector<log::Mistake> mistakes;
  std::optional<study::FirstLook> look;
};

LearnableLog look_at(const log::LogSource& source, const log::Roles& roles,
                     const log::Draft& draft) {
  LearnableLog found;
  try {
    const log::Log log = log::read_log(source, {}, roles);
    warn("{}", log::left_out_text(log.table, log.roles));
    const log::Dataset data = log.dataset();
    found.mistakes = log::all_mistakes(data, "auto");
    found.look = study::first_look(data);
  } catch (const InputError& error) {
    if (draft.is_complete()) {
      warn("no first look: {}\n", error.what());
    }
  }
  return found;
}

void inspect(const InspectArguments& options) {
  const log::LogSource& source = options.log.source;
  const log::Roles roles = options.log.over({});
  std::vector<std::string> taken{source.path};
  for (const auto& [option, file] :
       {std::pair("--json", options.json), std::pair("--template", options.draft)}) {
    if (!file.empty()) {
      check_output(option, file, taken);
      taken.push_back(file);
    }
  }
  const auto [report, draft, losses] = log::inspect_log(source, roles);
  const auto [mistakes, look] = look_at(source, roles, draft);
  if (!options.json.empty()) {
    file::write_file_whole(options.json,
                           report::inspect_json(report, draft, look, mistakes, source.path));
  }
  say("{}", report::inspect_table(report, source.path));
  say("{}", report::draft_table(draft, look) + report::mistakes_text(mistakes));
  if (!options.draft.empty()) {
    file::write_file_whole(options.draft, draft.toml());
    say("template: {}{}\n", options.draft,
        draft.is_complete() ? "" : ", which isn't complete; it says what is open");
  }
  warn("{}", losses);
}

}  // namespace

void add_inspect(CLI::App& app) {
  const auto [command, options] = add_command(
      app, "inspect",
      "Say what is in a log: topics, rates, gaps, ranges, noise, what can be learned", inspect);
  add_bag_options(*command, options->log.source, "log", "the log: " + log_formats());
  add_clock_options(*command, options->log.time, options->log.rate_hz);
  add_units_option(*command, options->log.units);
  add_missing_option(*command, options->log.missing);
  add_file(command, "--json", options->json, "write the report to this file, too");
  add_file(command, "--template", options->draft,
           "write the configuration that `kelpie learn` takes by --config to this file, as "
           "types, names and units tell it, with the reasons");
  add_examples(command, "inspect dive.bag",
               "inspect dive.tlog --template vehicle.toml --json dive.json");
}

}  // namespace kelpie::cli
