// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "study/result.hpp"

namespace kelpie::report {

/// A command for the user's next step, with its purpose.
struct NextStep {
  std::string command;
  std::string purpose;
};

/// The commands after `kelpie learn`, of a log and the path of its model; first, where the vehicle
/// changed and kTuning.rows_since or more rows follow, the command that learns these rows alone;
/// not where a thruster is back at its nominal thrust.
std::vector<NextStep> after_learning(const study::StreamResult& result, const std::string& log,
                                     const std::string& model);

/// The commands after a model of no use: of the log's file, and of the log with its options.
std::vector<NextStep> after_poor_model(const std::string& file, const std::string& log);

}  // namespace kelpie::report
