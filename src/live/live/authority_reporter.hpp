// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kelpie/alignment/alignment.hpp"
#include "kelpie/motion/unit.hpp"
#include "kelpie/vehicle/diagnosis.hpp"
#include "live/configuration.hpp"
#include "live/health.hpp"
#include "live/output.hpp"

namespace kelpie::live {

/// Reports what the thrusters can still do (howto/diagnosis.md#authority): numbers for the health,
/// and an event where authority is lost or comes back. For the learning thread.
class AuthorityReporter {
 public:
  /// Requires that the configuration outlives this.
  explicit AuthorityReporter(const Configuration& configuration);

  /// Widens the ranges of commands by an aligned row of inputs.
  void observe(std::span<const double> x);

  /// Fills in the authority of `health`; an event where an axis has changed by a twentieth of its
  /// nominal range since the last one. `diagnosis`: null where there is none. Allocates.
  void update(const Diagnosis* diagnosis, const Alignment& alignment, double t,
              LearnerHealth& health, Output& output);

 private:
  std::vector<CommandRange> ranges(const Diagnosis& diagnosis) const;
  std::string_view speed_unit(const Diagnosis& diagnosis) const;

  const StreamPlan* plan_;
  std::map<std::string, Unit> units_;
  std::vector<double> least_, most_;  // of every input
  std::vector<double> told_;          // share left of each axis
  std::size_t lost_told_ = std::numeric_limits<std::size_t>::max();
};

}  // namespace kelpie::live
