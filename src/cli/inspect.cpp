// SPDX-License-Identifier: Apache-2.0
#include "bag/inspect.hpp"

#include <memory>
#include <string>

#include "cli/bag_options.hpp"
#include "cli/commands.hpp"
#include "cli/output.hpp"
#include "file/atomic_file.hpp"
#include "report/inspect_report.hpp"

namespace kelpie::cli {
namespace {

struct InspectArguments {
  log::LogSource bag;
  std::string json;
};

void inspect(const InspectArguments& options) {
  if (!options.json.empty()) {
    check_output("--json", options.json, {options.bag.path});
  }
  const bag::MessageDefinitions definitions(options.bag.definitions);
  const std::unique_ptr<bag::BagReader> bag = options.bag.open_bag();
  const bag::BagReport found = bag::inspect_bag(*bag, definitions);
  if (!options.json.empty()) {
    file::write_file_whole(options.json, report::inspect_json(found, options.bag.path));
  }
  say("{}", report::inspect_table(found, options.bag.path));
  warn("{}", bag->losses_text());
}

}  // namespace

void add_inspect(CLI::App& app) {
  auto options = std::make_shared<InspectArguments>();
  CLI::App* const command =
      app.add_subcommand("inspect", "Say what is in a ROS 2 bag: topics, rates, gaps, ranges");
  add_bag_options(*command, options->bag);
  command->add_option("--json", options->json, "write the report to this file, too")
      ->type_name("FILE");
  command->callback([options] { inspect(*options); });
}

}  // namespace kelpie::cli
