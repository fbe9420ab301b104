// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

namespace kelpie {

/// Who is at work on a model: one thread that changes it, or any number that read it. Nobody waits:
/// who comes in between gets an InputError instead of half an update. A copy of a model is used by
/// nobody. Two atomic operations per call, against microseconds of a prediction.
class InUse {
 public:
  InUse() = default;
  ~InUse() = default;
  InUse(const InUse& /*other*/) noexcept {}                            ///< Used by nobody.
  InUse(InUse&& /*other*/) noexcept {}                                 ///< Used by nobody.
  InUse& operator=(const InUse& /*other*/) noexcept { return *this; }  ///< Users stay.
  InUse& operator=(InUse&& /*other*/) noexcept { return *this; }       ///< Users stay.

  /// Held as long as a thread reads. Throws InputError while another one writes.
  class Reading {
   public:
    explicit Reading(const InUse& model);  ///< Until it ends.
    ~Reading() { model_.users_.fetch_sub(1); }
    Reading(const Reading&) = delete;
    Reading(Reading&&) = delete;
    Reading& operator=(const Reading&) = delete;
    Reading& operator=(Reading&&) = delete;

   private:
    const InUse& model_;
  };

  /// Held as long as a thread writes. Throws InputError while another one reads or writes.
  class Writing {
   public:
    explicit Writing(const InUse& model);  ///< Until it ends.
    ~Writing() { model_.users_.fetch_sub(kWriter); }
    Writing(const Writing&) = delete;
    Writing(Writing&&) = delete;
    Writing& operator=(const Writing&) = delete;
    Writing& operator=(Writing&&) = delete;

   private:
    const InUse& model_;
  };

 private:
  static constexpr int kWriter = -1'000'000'000;  // less than any number of readers makes up for

  mutable std::atomic<int> users_{0};
};

}  // namespace kelpie
