// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli/output.hpp"

namespace kelpie::cli {

/// The program: kelpie in the target kelpie_program, kelpie-lab in kelpie_lab_program. Words,
/// streams and exit code are those of run_program().
int program(const std::vector<std::string>& words, const Streams& streams);

}  // namespace kelpie::cli
