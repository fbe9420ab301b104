// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "bag/bag.hpp"

namespace kelpie::cli {

/// The options that say which bag (or log) is read, and how.
struct BagOptions {
  std::string path;
  std::string definitions;
  bool recover = false;

  /// `name` is what the command calls it, `meaning` what it says of it.
  void add_to(CLI::App& command, const std::string& name = "bag",
              const std::string& meaning = "a rosbag2 folder, or one .db3 or .mcap file");
  std::unique_ptr<bag::BagReader> open() const;
};

/// Says on stderr what of a damaged bag was lost, if anything.
void print_losses(const bag::BagReader& bag);

}  // namespace kelpie::cli
