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

void Tally::visit(Archive& archive) {
  constexpr std::int64_t kMost = std::int64_t{1} << 53;
  for (std::int64_t* total :
       {&accepted, &explained, &duplicate, &invalid, &outliers, &forgotten, &released, &unserved,
        &crowded_out, &unfinished, &fallbacks, &suspicions, &changes, &recalls}) {
    archive.whole(*total, -kMost, kMost);  // `forgotten` may go down
  }
}

void Status::visit(Archive& archive) {
  archive.whole(buffer);
  archive.whole(support_vectors);
  archive.number(kkt_gap);
  archive.flag(ready);
  archive.part("tally", tally);
}

}  // namespace kelpie
