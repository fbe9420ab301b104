// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/commands.hpp"

namespace kelpie::cli {

// The commands of kelpie-live; cli/commands.hpp describes the convention.

void add_live(CLI::App& app);
void add_play(CLI::App& app);

}  // namespace kelpie::cli
