// SPDX-License-Identifier: Apache-2.0
#include "kelpie/svr/regressor.hpp"

namespace kelpie {

void Status::visit(Archive& archive) {
  archive.whole(buffer);
  archive.whole(support_vectors);
  archive.number(kkt_gap);
  archive.flag(ready);
  archive.part("tally", tally);
}

}  // namespace kelpie
