// SPDX-License-Identifier: Apache-2.0
#include "model/access_guard.hpp"

#include "kelpie/core/error.hpp"

namespace kelpie {
namespace {

[[noreturn]] void refuse() {
  throw InputError("model",
                   "is being updated while another thread uses it; serialise the calls or use "
                   "SharedModel");
}

}  // namespace

AccessGuard::Reader::Reader(const AccessGuard& model) : model_(model) {
  if (model_.users_.fetch_add(1) < 0) {
    model_.users_.fetch_sub(1);
    refuse();
  }
}

AccessGuard::Writer::Writer(const AccessGuard& model) : model_(model) {
  int none = 0;
  if (!model_.users_.compare_exchange_strong(none, kWriter)) {
    refuse();
  }
}

}  // namespace kelpie
