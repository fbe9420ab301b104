// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace kelpie::jobs {

/// What one of several processes was sent by another.
struct Message {
  std::size_t from = 0;
  int kind = 0;
  std::string text;
};

/// Carries messages between the processes that were started together, which are numbered: their
/// ranks. Messages of one process to another arrive whole and in their order. Used by one thread,
/// always the same.
class Messenger {
 public:
  /// A message's text has at most so many bytes.
  static constexpr std::size_t kMostBytes = std::numeric_limits<int>::max();

  Messenger() = default;
  virtual ~Messenger() = default;
  Messenger(const Messenger&) = delete;
  Messenger(Messenger&&) = delete;
  Messenger& operator=(const Messenger&) = delete;
  Messenger& operator=(Messenger&&) = delete;

  virtual std::size_t rank() const = 0;
  virtual std::size_t size() const = 0;  ///< how many processes there are
  virtual std::string host() const = 0;  ///< the machine's name
  /// Long texts may take until the other process receives. Requires kind >= 0, another rank.
  virtual void send(std::size_t to, int kind, std::string_view text) = 0;
  /// The next message, if there is one. Doesn't wait.
  virtual std::optional<Message> receive() = 0;
};

/// What a plug-in exports by the name kOpenMessenger: begins to speak, once in a process. Null,
/// before anything was begun, unless `version` is that of the plug-in, which `own` then tells.
using OpenMessenger = Messenger* (*)(const char* version, const char** own);
inline constexpr const char* kOpenMessenger = "kelpie_open_messenger";

}  // namespace kelpie::jobs
