// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstddef>

// Counts what malloc is asked for: Eigen allocates past operator new. It replaces malloc, weakly,
// so that several files of a test program may include it. The sanitizers bring a malloc of their
// own.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
extern "C" void* __libc_malloc(std::size_t size);  // NOLINT: the C library's name

namespace kelpie::testing {
inline std::size_t allocations = 0;      // NOLINT: malloc has nowhere else to count
inline std::size_t allocated_bytes = 0;  // NOLINT
}  // namespace kelpie::testing

// NOLINTNEXTLINE(misc-definitions-in-headers): weak, so every file may bring it
extern "C" __attribute__((weak)) void* malloc(std::size_t size) noexcept {
  ++kelpie::testing::allocations;
  kelpie::testing::allocated_bytes += size;
  return __libc_malloc(size);
}

#define KELPIE_NEEDS_ALLOCATION_COUNT() static_cast<void>(0)
#else
namespace kelpie::testing {
inline std::size_t allocations = 0;
inline std::size_t allocated_bytes = 0;
}  // namespace kelpie::testing

#define KELPIE_NEEDS_ALLOCATION_COUNT() GTEST_SKIP() << "a sanitizer brings its own malloc"
#endif
