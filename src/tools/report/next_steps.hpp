// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "study/result.hpp"

namespace kelpie::report {

/// A command for the user's next step, with its purpose.
struct NextStep {
  std::string command;
  std::string purpose;
};

/// A log as the next commands take it; options begin with a blank.
struct LogWords {
  std::string file{};
  std::optional<std::string> learning{};  ///< options of `learn`; none: not to be learned anew
  std::optional<std::string> judging{};   ///< options of `rollout`; none: no rows were held out
  std::string reading{};                  ///< options by which another such log is read
  std::optional<std::string> planning{};  ///< options of `plan`; none: not to be planned
};

/// The commands after `kelpie learn`, with the path of the model. First, where two causes explain
/// the last change and `kelpie plan --apart` knows both, the command that plans a drive to tell
/// them apart, for a change of the size found. Then, where the vehicle changed and
/// kTuning.rows_since or more rows follow, the command that learns these rows alone; not where a
/// thruster is back at its nominal thrust.
/// `kelpie rollout` stands among them where velocities are known and rows are held out, else,
/// without velocities, the setting that tells them.
std::vector<NextStep> after_learning(const study::StreamResult& result, const LogWords& log,
                                     const std::string& model);

/// The commands after a model of no use: of the log's file, and of the log with its options.
std::vector<NextStep> after_poor_model(const std::string& file, const std::string& log);

}  // namespace kelpie::report
