// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "dds/peer_commands.hpp"
#include "dds/publication.hpp"
#include "dds/subscription.hpp"
#include "file/descriptor.hpp"

namespace kelpie::testing {

constexpr std::chrono::minutes kPatience{5};  // on a busy machine; nothing waits so long in vain

/// A DDS domain that no other test of this machine is in at the same time.
inline std::uint32_t own_domain() {
  constexpr std::uint32_t kFirst = 20;  // those below are people's
  constexpr std::uint32_t kEnd = 100;   // ports of those above may be given to anybody
  static std::unique_ptr<file::Descriptor> held;
  static std::uint32_t domain = 0;
  for (std::uint32_t next = kFirst; held == nullptr && next < kEnd; ++next) {
    auto file = std::make_unique<file::Descriptor>(
        std::filesystem::temp_directory_path() / ("kelpie-dds-domain-" + std::to_string(next)),
        O_RDWR | O_CREAT);
    if (file->is_open() && file->lock(LOCK_EX | LOCK_NB)) {
      domain = next;
      held = std::move(file);
    }
  }
  if (held == nullptr) {
    throw std::runtime_error("no DDS domain is free for this test");
  }
  return domain;
}

/// Whether `holds` becomes true while one is patient.
template <typename Condition>
bool eventually(const Condition& holds) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!holds()) {
    if (std::chrono::steady_clock::now() > end) {
      return false;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

/// A program beside the test that does what its lines say (peer_commands.hpp).
class Peer {
 public:
  explicit Peer(const std::string& program) {
    std::array<int, 2> to{};
    std::array<int, 2> from{};
    if (::pipe2(to.data(), O_CLOEXEC) != 0 || ::pipe2(from.data(), O_CLOEXEC) != 0) {
      throw std::runtime_error("no pipe");
    }
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, to[0], STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, from[1], STDOUT_FILENO);
    std::string name = program;
    std::string domain = std::to_string(own_domain());
    std::array<char*, 3> arguments{name.data(), domain.data(), nullptr};
    const int failed =
        ::posix_spawn(&process_, name.c_str(), &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    ::close(to[0]);
    ::close(from[1]);
    to_ = to[1];
    from_ = from[0];
    if (failed != 0) {
      throw std::runtime_error(program + " couldn't be started");
    }
  }
  ~Peer() {
    signal(SIGCONT);
    ::close(to_);  // it ends with its input, or when nobody hears it, or has to be ended
    ::close(from_);
    if (!eventually([&] { return ::waitpid(process_, nullptr, WNOHANG) != 0; })) {
      signal(SIGKILL);
      ::waitpid(process_, nullptr, 0);
    }
  }
  Peer(const Peer&) = delete;
  Peer(Peer&&) = delete;
  Peer& operator=(const Peer&) = delete;
  Peer& operator=(Peer&&) = delete;

  void say(const std::string& line) const {
    const std::string text = line + "\n";
    if (::write(to_, text.data(), text.size()) != static_cast<ssize_t>(text.size())) {
      ADD_FAILURE() << "the peer doesn't listen: " << line;
    }
  }
  /// Says it and waits until it is done.
  void order(const std::string& line) {
    say(line);
    answer(line.substr(0, line.find(' ')));
  }
  /// The rest of the next line that begins with this word; lines before it are dropped.
  std::string answer(const std::string& word) {
    const auto end = std::chrono::steady_clock::now() + kPatience;
    for (;;) {
      if (const auto rest = taken(word)) {
        return *rest;
      }
      if (std::chrono::steady_clock::now() > end || !hear()) {
        ADD_FAILURE() << "the peer never said " << word;
        return "";
      }
    }
  }
  /// The same of the lines that the peer has said so far; empty: no such line.
  std::optional<std::string> said(const std::string& word) {
    hear(0);
    return taken(word);
  }
  /// Whether the peer has said this word as a line; the lines before are dropped then.
  bool has_said(const std::string& word) {
    hear(0);
    const std::size_t at = ("\n" + heard_).find("\n" + word + "\n");
    heard_.erase(0, at == std::string::npos ? 0 : at + word.size() + 1);
    return at != std::string::npos;
  }
  void signal(int number) const { ::kill(process_, number); }

 private:
  std::optional<std::string> taken(const std::string& word) {
    for (std::size_t length = 0; (length = heard_.find('\n')) != std::string::npos;) {
      const std::string line = heard_.substr(0, length);
      heard_.erase(0, length + 1);
      if (line == word || line.starts_with(word + " ")) {
        return line.substr(std::min(line.size(), word.size() + 1));
      }
    }
    return std::nullopt;
  }
  bool hear(int milliseconds = 100) {
    pollfd ready{from_, POLLIN, 0};
    if (::poll(&ready, 1, milliseconds) <= 0) {
      return true;
    }
    std::array<char, 4096> part{};
    const ssize_t count = ::read(from_, part.data(), part.size());
    heard_.append(part.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    return count > 0;
  }

  pid_t process_ = 0;
  int to_ = -1;
  int from_ = -1;
  std::string heard_;
};

/// Whether what the peer publishes comes in at the subscription.
inline bool connected(Peer& peer, const dds::Subscription& subscription) {
  const std::uint64_t before = subscription.received();
  return eventually([&] {
    peer.order("send " + hex_of(hello()));
    return subscription.received() > before;
  });
}

/// Whether what is published comes to the peer, which has one subscription.
inline bool connected(Peer& peer, dds::Publication& publication) {
  return eventually([&] { return publication.publish(hello()) && peer.has_said("hello"); });
}

/// The next message that isn't a hello; false where none comes.
inline bool take(dds::MessageQueue& queue, dds::TopicSample& message) {
  while (queue.pop(message, kPatience)) {
    if (message.cdr != hello()) {
      return true;
    }
  }
  return false;
}

}  // namespace kelpie::testing
