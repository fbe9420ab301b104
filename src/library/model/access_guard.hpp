// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

namespace kelpie {

/// Access to a model: one writing thread, or any number of reading threads. Never waits: a
/// conflicting access throws InputError instead of seeing half an update. A copied or moved guard
/// is free. Cost: two atomic operations per access, against microseconds of a prediction.
class AccessGuard {
 public:
  AccessGuard() = default;
  ~AccessGuard() = default;
  AccessGuard(const AccessGuard& /*other*/) noexcept {}  ///< Free.
  AccessGuard(AccessGuard&& /*other*/) noexcept {}       ///< Free.
  AccessGuard& operator=(const AccessGuard& /*other*/) noexcept {
    return *this;
  }  ///< Keeps its accesses.
  AccessGuard& operator=(AccessGuard&& /*other*/) noexcept {
    return *this;
  }  ///< Keeps its accesses.

  /// A reading access. Throws InputError during a writing access.
  class Reader {
   public:
    explicit Reader(const AccessGuard& model);  ///< Until destruction.
    ~Reader() { model_.users_.fetch_sub(1); }
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

   private:
    const AccessGuard& model_;
  };

  /// The writing access. Throws InputError during any other access.
  class Writer {
   public:
    explicit Writer(const AccessGuard& model);  ///< Until destruction.
    ~Writer() { model_.users_.fetch_sub(kWriter); }
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;

   private:
    const AccessGuard& model_;
  };

 private:
  static constexpr int kWriter = -1'000'000'000;  // below any number of readers

  mutable std::atomic<int> users_{0};
};

}  // namespace kelpie
