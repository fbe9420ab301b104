// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace kelpie::report {

/// A command for the user's next step, with its purpose.
struct NextStep {
  std::string command;
  std::string purpose;
};

/// The commands after `kelpie learn`, of a log and the path of its model.
std::vector<NextStep> after_learning(const std::string& log, const std::string& model);

}  // namespace kelpie::report
