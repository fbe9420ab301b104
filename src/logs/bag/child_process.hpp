// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "file/descriptor.hpp"

namespace kelpie::bag {

/// Bounds of a child process.
struct ChildLimits {
  std::size_t bytes = 0;  ///< of memory, on top of the memory of the process at the fork
  int seconds = 0;        ///< of wall clock, and of processor time
};

/// Work in a forked child process with bounded memory and time, for libraries that crash on damaged
/// files. The child writes bytes to a pipe, the parent reads the bytes. The child ends when `work`
/// returns, at a limit, and with the parent; the destructor ends the child. Parents may have
/// further threads (Python, for instance): of these the child has none. Memory can be allocated in
/// the child, since glibc's fork() takes the locks of malloc; `work` must not use objects that
/// further threads of the parent use, for a lock taken at the fork is never released in the child.
/// A child that waits for such a lock ends at its limit of time.
class ChildProcess {
 public:
  /// Writes all bytes to the parent. Throws Failure when the parent is gone.
  using Write = std::function<void(std::span<const std::byte> bytes)>;

  /// Forks. `work` runs in the child, with stderr discarded; an exception of `work` is an
  /// unsuccessful end. Throws Failure without resources for a pipe or a process.
  ChildProcess(const std::function<void(const Write& write)>& work, const ChildLimits& limits);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Fills `bytes`; false where the child ends before, or takes longer than allowed.
  bool read(std::span<std::byte> bytes);

  /// Why the child gave no more bytes, for messages: "ended by signal 11 (Segmentation fault)".
  /// Ends a child that runs on.
  std::string end();

 private:
  ChildLimits limits_;
  std::chrono::steady_clock::time_point deadline_;
  std::unique_ptr<file::Descriptor> from_child_;
  pid_t process_ = -1;
  bool is_late_ = false;
};

}  // namespace kelpie::bag
