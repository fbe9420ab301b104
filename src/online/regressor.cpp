// SPDX-License-Identifier: Apache-2.0
#include "kelpie/online/regressor.hpp"

namespace kelpie {

void Tally::add(const Decision& decision) {
  accepted += decision.verdict == Verdict::accepted ? 1 : 0;
  explained += decision.verdict == Verdict::explained ? 1 : 0;
  duplicate += decision.verdict == Verdict::duplicate ? 1 : 0;
  invalid += decision.verdict == Verdict::invalid ? 1 : 0;
  crowded_out += decision.verdict == Verdict::crowded_out ? 1 : 0;
  outliers += decision.outliers;
  forgotten += decision.forgotten;
  released += decision.released;
  unserved += decision.unserved ? 1 : 0;
  unfinished += decision.unfinished ? 1 : 0;
  fallbacks += decision.fallbacks;
}

}  // namespace kelpie
