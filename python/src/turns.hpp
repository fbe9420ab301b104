// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>
#include <sys/types.h>
#include <unistd.h>

#include <mutex>
#include <optional>
#include <shared_mutex>

#include "kelpie/core/error.hpp"

namespace kelpie::python {

/// The turns that threads of Python take with one thing: any number of readers, or one writer.
class Turns {
 public:
  /// Throws Failure in a forked process where a thread had its turn during the fork: the thread is
  /// not there to end the turn, and the thing is half changed. Requires the GIL.
  void require_whole() {
    if (process_ == ::getpid()) {
      return;
    }
    if (!mutex.try_lock()) {
      throw Failure(
          "another thread was at work here when this process was forked, and its work is lost: "
          "start processes by multiprocessing's 'spawn' or 'forkserver', or fork before threads");
    }
    mutex.unlock();
    process_ = ::getpid();
  }

  std::shared_mutex mutex{};

 private:
  ::pid_t process_ = ::getpid();
};

/// A turn, during which other threads of Python run. Requires the GIL, and has it back at the end.
template <typename Lock>
class Turn {
 public:
  explicit Turn(Turns& turns) {
    turns.require_whole();
    release_.emplace();
    lock_ = Lock(turns.mutex);
  }

 private:
  std::optional<pybind11::gil_scoped_release> release_{};
  Lock lock_{};  // ends before the GIL is waited for
};

using ReadingTurn = Turn<std::shared_lock<std::shared_mutex>>;
using WritingTurn = Turn<std::unique_lock<std::shared_mutex>>;

}  // namespace kelpie::python
