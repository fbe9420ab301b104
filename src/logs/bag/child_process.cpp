// SPDX-License-Identifier: Apache-2.0
#include "bag/child_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>
#include <fstream>
#include <system_error>

#include "kelpie/core/error.hpp"

namespace kelpie::bag {
namespace {

[[noreturn]] void fail_child(const std::string& what) {
  throw Failure("a process to read the file in: " + what + ": " +
                std::generic_category().message(errno));
}

void limit(__rlimit_resource resource, rlim_t most) {
  rlimit bounds{};
  ::getrlimit(resource, &bounds);
  bounds.rlim_max = std::min(bounds.rlim_max, most);
  bounds.rlim_cur = std::min(bounds.rlim_cur, bounds.rlim_max);
  ::setrlimit(resource, &bounds);
}

// Address space of this process at present.
std::size_t used_bytes() {
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

void write_all(int to, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(to, bytes.data(), bytes.size());
    if (written < 0 && errno != EINTR) {
      throw Failure("the parent is gone");
    }
    bytes = bytes.subspan(written > 0 ? static_cast<std::size_t>(written) : 0);
  }
}

// In the child. _exit: destructors and buffered output belong to the parent.
[[noreturn]] void run_child(int to, pid_t parent, const ChildLimits& limits,
                            const std::function<void(const ChildProcess::Write&)>& work) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) {
    ::_exit(1);
  }
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_AS, used_bytes() + limits.bytes);
  limit(RLIMIT_CPU, static_cast<rlim_t>(limits.seconds));
  constexpr int kPipe = STDERR_FILENO + 1;
  ::dup2(to, kPipe);
  ::close_range(kPipe + 1, ~0U, 0);  // ends of pipes of other children: they would stay open
  ::dup2(::open("/dev/null", O_WRONLY), STDERR_FILENO);  // NOLINT: POSIX is variadic
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGXCPU, SIGPIPE}) {
    static_cast<void>(std::signal(signal, SIG_DFL));
  }
  try {
    work([](std::span<const std::byte> bytes) { write_all(kPipe, bytes); });
    ::_exit(0);
  } catch (const std::exception&) {
    ::_exit(1);
  }
}

}  // namespace

ChildProcess::ChildProcess(const std::function<void(const Write& write)>& work,
                           const ChildLimits& limits)
    : limits_(limits),
      deadline_(std::chrono::steady_clock::now() + std::chrono::seconds(limits.seconds)) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
    fail_child("no pipe");
  }
  from_child_ = std::make_unique<file::Descriptor>(ends[0]);
  const file::Descriptor to_parent(ends[1]);
  const pid_t parent = ::getpid();
  process_ = ::fork();
  if (process_ < 0) {
    fail_child("no process");
  }
  if (process_ == 0) {
    run_child(to_parent.number(), parent, limits, work);
  }
}

ChildProcess::~ChildProcess() {
  end();
}

bool ChildProcess::read(std::span<std::byte> bytes) {
  using std::chrono::milliseconds;
  while (!bytes.empty() && !is_late_) {
    const auto left =
        std::chrono::duration_cast<milliseconds>(deadline_ - std::chrono::steady_clock::now());
    pollfd waiting{.fd = from_child_->number(), .events = POLLIN, .revents = 0};
    const int ready =
        ::poll(&waiting, 1, static_cast<int>(std::max(left, milliseconds(0)).count()));
    is_late_ = ready == 0;
    if (ready < 0 && errno != EINTR) {
      fail_child("waiting for it");
    }
    if (ready > 0) {
      const ssize_t count = ::read(from_child_->number(), bytes.data(), bytes.size());
      if (count <= 0) {
        return false;
      }
      bytes = bytes.subspan(static_cast<std::size_t>(count));
    }
  }
  return bytes.empty();
}

std::string ChildProcess::end() {
  if (process_ < 0) {
    return "ended";
  }
  // A child that still has bytes to write is stopped; of one at its end the status is wanted.
  int status = 0;
  pollfd closed{.fd = from_child_->number(), .events = 0, .revents = 0};
  const bool has_ended = ::poll(&closed, 1, 0) > 0 && (closed.revents & POLLHUP) != 0;
  if (!has_ended) {
    ::kill(process_, SIGKILL);
  }
  while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  if (is_late_ || (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)) {
    return fmt::format("takes more than {} s", limits_.seconds);
  }
  if (WIFSIGNALED(status)) {
    return fmt::format("ended by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
  }
  return WEXITSTATUS(status) == 0 ? "ended too early" : "failed";
}

}  // namespace kelpie::bag
