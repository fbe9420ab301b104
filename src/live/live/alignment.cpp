// SPDX-License-Identifier: Apache-2.0
#include "live/alignment.hpp"

#include <algorithm>

#include "kelpie/alignment/alignment.hpp"
#include "kelpie/alignment/live_alignment.hpp"
#include "kelpie/core/error.hpp"
#include "live/checkpoint.hpp"
#include "live/tuning.hpp"
#include "study/alignment.hpp"

namespace kelpie::live {
Alignment alignment_of(const Configuration& configuration, double seconds) {
  const StreamPlan& plan = configuration.plan;
  const Alignment alignment = Alignment::by(
      seconds, plan.inputs,
      named_commands(plan.inputs, plan.targets.size(), configuration.settings.shared.states),
      plan.rate_hz);
  if (alignment.commands.empty()) {
    throw InputError({.file = configuration.file, .line = 0, .field = "live.align"},
                     "no inputs are known to be velocities and others commands; name the "
                     "velocities, as in states = \"u,v,r\"");
  }
  return alignment.with(study::known_actuators(configuration.log.roles.actuators));
}

std::size_t rows_to_keep(const Configuration& configuration,
                         const std::optional<log::Reach>& recording) {
  const auto usual = static_cast<double>(LiveAlignment::kUsualKeep);
  // Longer than a log can be: a clock was set in it, and its end tells nothing of its rows.
  const bool is_one_log = recording && recording->end_s <= LearningClock::kLongestPause;
  const bool keeps_all = is_one_log && configuration.live.align == "auto";
  const double rows = keeps_all ? recording->end_s * configuration.plan.rate_hz + 1.0 : usual;
  return static_cast<std::size_t>(std::clamp(rows, usual, kTuning.most_kept_rows));
}

}  // namespace kelpie::live
