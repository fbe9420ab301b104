// SPDX-License-Identifier: Apache-2.0
#include "cli/bag_options.hpp"

#include <fmt/core.h>

namespace kelpie::cli {

void BagOptions::add_to(CLI::App& command, const std::string& name, const std::string& meaning) {
  command.add_option(name, path, meaning)->required()->type_name("FILE");
  command
      .add_option("--msg-dir", definitions,
                  "folder of .msg files, for types that the bag doesn't define")
      ->type_name("FOLDER");
  command.add_flag("--recover", recover,
                   "read what can be read of a damaged bag, and say what was lost");
}

std::unique_ptr<bag::BagReader> BagOptions::open() const {
  return bag::open_bag(path, recover ? bag::ReadMode::recover : bag::ReadMode::strict);
}

void print_losses(const bag::BagReader& bag) {
  for (const std::string& loss : bag.losses()) {
    fmt::print(stderr, "lost: {}\n", loss);
  }
  if (bag.loss_count() > bag.losses().size()) {
    fmt::print(stderr, "lost: {} more\n", bag.loss_count() - bag.losses().size());
  }
}

}  // namespace kelpie::cli
