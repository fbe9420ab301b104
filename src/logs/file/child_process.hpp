// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kelpie::file {

/// Runs a program of PATH with arguments, and waits. Returns waitpid's status: 0 for success. With
/// an `output` file the program's output and messages go there. Throws Failure where the program
/// cannot be run: "`what` 'NAME' cannot be run: REASON; `remedy`".
int run_child(std::vector<std::string> words, const std::string& what, const std::string& remedy,
              const std::filesystem::path& output = {});

}  // namespace kelpie::file
