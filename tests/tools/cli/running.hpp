// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <functional>
#include <string>
#include <tuple>
#include <vector>

namespace kelpie::testing {

/// The built kelpie at work in `folder`, on a terminal of its own: it shows its progress there, and
/// Ctrl-C reaches it as it does from a keyboard. Its standard output is thrown away.
class Running {
 public:
  Running(const std::filesystem::path& folder, const std::vector<std::string>& arguments) {
    std::vector<char*> list{const_cast<char*>("kelpie")};  // NOLINT: as execv wants it
    for (const std::string& argument : arguments) {
      list.push_back(const_cast<char*>(argument.c_str()));  // NOLINT
    }
    list.push_back(nullptr);
    child_ = ::forkpty(&terminal_, nullptr, nullptr, nullptr);
    if (child_ == 0) {
      std::ignore = std::signal(SIGINT, SIG_DFL);      // the shell of a background job ignores it
      const int sink = ::open("/dev/null", O_WRONLY);  // NOLINT: POSIX is variadic
      if (::chdir(folder.c_str()) == 0 && ::dup2(sink, STDOUT_FILENO) >= 0) {
        ::execv(KELPIE_COMMAND, list.data());
      }
      ::_exit(127);
    }
    EXPECT_GT(child_, 0) << "no terminal can be had";
  }
  ~Running() {
    kill();
    ::close(terminal_);
  }
  Running(const Running&) = delete;
  Running(Running&&) = delete;
  Running& operator=(const Running&) = delete;
  Running& operator=(Running&&) = delete;

  /// Waits until `happened` says so. False: the program ended before, or five minutes went by, as
  /// many as a busy machine may take.
  bool wait_until(const std::function<bool()>& happened) {
    const auto limit = std::chrono::steady_clock::now() + std::chrono::minutes(5);
    while (!happened()) {
      if (!read_terminal() || std::chrono::steady_clock::now() > limit) {
        return false;
      }
    }
    return true;
  }
  /// The same for a text on the terminal.
  bool wait_for_text(const std::string& text) {
    return wait_until([&] { return terminal_text_.find(text) != std::string::npos; });
  }

  void press_ctrl_c() const { EXPECT_EQ(::write(terminal_, "\x03", 1), 1); }
  void send(int signal) const { EXPECT_EQ(::kill(child_, signal), 0); }

  /// Waits for the end: the exit code, or the signal that ended it as a negative number. After five
  /// minutes it is killed.
  int exit_code() {
    wait_until([] { return false; });
    return kill();
  }
  /// Kills it, unless it has ended by itself. What exit_code() says.
  int kill() {
    if (child_ > 0) {
      ::kill(child_, SIGKILL);
    }
    return reap();
  }

  const std::string& terminal_text() const { return terminal_text_; }

 private:
  // Takes what the program writes within some milliseconds; false once it has hung up.
  bool read_terminal() {
    if (child_ <= 0) {
      return false;
    }
    pollfd ready{.fd = terminal_, .events = POLLIN, .revents = 0};
    if (::poll(&ready, 1, 5) <= 0) {
      return true;
    }
    std::array<char, 4096> bytes{};
    const ssize_t count = ::read(terminal_, bytes.data(), bytes.size());
    terminal_text_.append(bytes.data(), count > 0 ? static_cast<std::size_t>(count) : 0U);
    return count > 0;
  }

  int reap() {
    if (child_ > 0) {
      int status = 0;
      ::waitpid(child_, &status, 0);
      code_ = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
      child_ = 0;
    }
    return code_;
  }

  pid_t child_ = 0;
  int terminal_ = -1;
  int code_ = 127;
  std::string terminal_text_;
};

}  // namespace kelpie::testing
