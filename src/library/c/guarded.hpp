// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>

#include "kelpie/core/error.hpp"
#include "kelpie/kelpie.h"

namespace kelpie {

/// Keeps the message for kelpie_last_error().
void keep_error(const char* message);

/// Runs `work`, which may throw, behind the interface of C.
template <typename Work>
kelpie_status guarded(const Work& work) {
  try {
    work();
    return KELPIE_OK;
  } catch (const InputError& error) {
    keep_error(error.what());
    return KELPIE_BAD_INPUT;
  } catch (const std::exception& error) {
    keep_error(error.what());
  } catch (...) {
    keep_error("something was thrown that is no exception of the standard library");
  }
  return KELPIE_FAILED;
}

/// Throws InputError (`what`) on a null pointer.
inline void require_pointer(const char* what, const void* pointer) {
  if (pointer == nullptr) {
    throw InputError(what, "is null");
  }
}

}  // namespace kelpie
