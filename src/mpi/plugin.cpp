// SPDX-License-Identifier: Apache-2.0
// The one function of libkelpie_mpi.so that others see: jobs::OpenMessenger.
#include <cstring>

#include "mpi/mpi_messenger.hpp"

namespace kelpie::mpi {

extern "C" __attribute__((visibility("default"))) jobs::Messenger* kelpie_open_messenger(
    const char* version, const char** own) {
  *own = KELPIE_VERSION;
  // NOLINTNEXTLINE(cppcoreguidelines-owning-memory): whoever loads it owns what it opens
  return std::strcmp(version, KELPIE_VERSION) == 0 ? new MpiMessenger() : nullptr;
}

}  // namespace kelpie::mpi
