// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "kelpie/bag/bag.hpp"

namespace kelpie::cli {

/// The options that say which bag is read, and how.
struct BagOptions {
  std::string bag;
  std::string definitions;
  bool recover = false;

  void add_to(CLI::App& command);
  std::unique_ptr<BagReader> open() const;
};

/// Says on stderr what of a damaged bag was lost, if anything.
void print_losses(const BagReader& bag);

}  // namespace kelpie::cli
