// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "kelpie/svr/regressor.hpp"
#include "kelpie/svr/settings.hpp"

namespace kelpie {

/// The including node: rejects samples without new information.
class IncludingGate {
 public:
  /// Requires settings that validate.
  explicit IncludingGate(const OnlineSvrSettings& settings)
      : epsilon_(settings.epsilon), xi_(settings.xi), a_(settings.a), b_(settings.b) {}

  /// `similarity[i]` = κ(x, x_i) and `targets[i]` = y_i of the buffer's samples; `predicted` =
  /// f(x). Ensures: the rule that rejects the sample, eq. (9) before eq. (10), or `accepted`.
  Verdict check(std::span<const double> similarity, std::span<const double> targets,
                double predicted, double y) const;

 private:
  double epsilon_;
  double xi_;
  double a_;
  double b_;
};

}  // namespace kelpie
