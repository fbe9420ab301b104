// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "cli/commands.hpp"
#include "cli/log_options.hpp"
#include "cli/options.hpp"
#include "cli/output.hpp"
#include "file/atomic_file.hpp"
#include "kelpie/core/error.hpp"
#include "log/draft.hpp"
#include "log/read_log.hpp"
#include "report/inspect_report.hpp"
#include "study/first_look.hpp"

namespace kelpie::cli {
namespace {

struct InspectArguments {
  log::LogSource log;
  std::string json;
  std::string draft;
};

// Reads the samples of the draft; where there are none, says why.
std::optional<study::FirstLook> look_at(const log::LogSource& source, const log::Draft& draft) {
  if (!draft.is_complete()) {
    return std::nullopt;
  }
  try {
    const log::LogConfig config = draft.config(source.path);
    return study::first_look(log::read_log(source, config, config.roles).dataset());
  } catch (const InputError& error) {
    warn("no first look: {}\n", error.what());
    return std::nullopt;
  }
}

void inspect(const InspectArguments& options) {
  for (const auto& [option, file] :
       {std::pair("--json", options.json), std::pair("--template", options.draft)}) {
    if (!file.empty()) {
      check_output(option, file, {options.log.path});
    }
  }
  const auto [report, draft, losses] = log::inspect_log(options.log);
  const std::optional<study::FirstLook> look = look_at(options.log, draft);
  if (!options.json.empty()) {
    file::write_file_whole(options.json,
                           report::inspect_json(report, draft, look, options.log.path));
  }
  say("{}", report::inspect_table(report, options.log.path));
  say("{}", report::draft_table(draft, look));
  if (!options.draft.empty()) {
    file::write_file_whole(options.draft, draft.toml);
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
  add_bag_options(*command, options->log, "log", "the log: " + log_formats());
  add_file(command, "--json", options->json, "write the report to this file, too");
  add_file(command, "--template", options->draft,
           "write the configuration that `kelpie learn` takes by --config to this file, as "
           "types, names and units tell it, with the reasons");
  add_examples(command, "inspect dive.bag",
               "inspect dive.tlog --template vehicle.toml --json dive.json");
}

}  // namespace kelpie::cli
