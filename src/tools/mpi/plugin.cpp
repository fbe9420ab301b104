// SPDX-License-Identifier: Apache-2.0
// The one function that libkelpie_mpi.so exports: jobs::OpenRankGroup.
#include <cstring>

#include "mpi/mpi_group.hpp"

namespace kelpie::mpi {

extern "C" __attribute__((visibility("default"))) jobs::RankGroup* kelpie_open_rank_group(
    const char* version, const char** own) {
  *own = KELPIE_VERSION;
  // NOLINTNEXTLINE(cppcoreguidelines-owning-memory): the caller owns what it opens
  return std::strcmp(version, KELPIE_VERSION) == 0 ? new MpiGroup() : nullptr;
}

}  // namespace kelpie::mpi
