// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

namespace kelpie {

/// Who is at work on a model: one thread that changes it, or any number that read it. Nobody waits:
/// who comes in between gets an InputError instead of half an update. A copy of a model is used by
/// nobody. Two atomic operations per call, against microseconds of a prediction.
class AccessGuard {
 public:
  AccessGuard() = default;
  ~AccessGuard() = default;
  AccessGuard(const AccessGuard& /*other*/) noexcept {}  ///< Used by nobody.
  AccessGuard(AccessGuard&& /*other*/) noexcept {}       ///< Used by nobody.
  AccessGuard& operator=(const AccessGuard& /*other*/) noexcept { return *this; }  ///< Users stay.
  AccessGuard& operator=(AccessGuard&& /*other*/) noexcept { return *this; }       ///< Users stay.

  /// Held as long as a thread reads. Throws InputError while another one writes.
  class Reader {
   public:
    explicit Reader(const AccessGuard& model);  ///< Until it ends.
    ~Reader() { model_.users_.fetch_sub(1); }
    Reader(const Reader&) = delete;
    Reader(Reader&&) = delete;
    Reader& operator=(const Reader&) = delete;
    Reader& operator=(Reader&&) = delete;

   private:
    const AccessGuard& model_;
  };

  /// Held as long as a thread writes. Throws InputError while another one reads or writes.
  class Writer {
   public:
    explicit Writer(const AccessGuard& model);  ///< Until it ends.
    ~Writer() { model_.users_.fetch_sub(kWriter); }
    Writer(const Writer&) = delete;
    Writer(Writer&&) = delete;
    Writer& operator=(const Writer&) = delete;
    Writer& operator=(Writer&&) = delete;

   private:
    const AccessGuard& model_;
  };

 private:
  static constexpr int kWriter = -1'000'000'000;  // less than any number of readers makes up for

  mutable std::atomic<int> users_{0};
};

}  // namespace kelpie
