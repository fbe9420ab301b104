// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "bag/open_bag.hpp"
#include "log/read_log.hpp"

namespace kelpie::live {

class Output;
class Requests;

/// State of a transport.
struct TransportHealth {
  std::size_t lost = 0;               ///< messages sent and not received, as far as is known
  std::size_t damaged = 0;            ///< frames and packets that cannot be read
  std::size_t unknown = 0;            ///< messages without a definition
  std::size_t refused = 0;            ///< messages of senders that cannot be trusted
  std::vector<std::string> faults{};  ///< present obstacles, a sentence each
};

/// Source of raw messages, in any encoding. For one thread.
class Transport {
 public:
  /// Result of next().
  enum class Got {
    message,
    nothing,  ///< within the timeout
    end,      ///< of a recording
  };

  Transport() = default;
  virtual ~Transport() = default;
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;

  /// The topics met so far. next() may append to the list; an index stays valid.
  virtual const std::vector<bag::Topic>& topics() const = 0;

  /// Fetches the next message, waiting for at most `timeout`. Its data stay valid until the next
  /// call.
  virtual Got next(bag::Message& message, std::chrono::milliseconds timeout) = 0;

  /// Reach of a recording, which waits for its reader. None of a live connection.
  virtual std::optional<log::Reach> reach() const { return std::nullopt; }

  virtual TransportHealth health() const { return {}; }

  /// Describes the connection and the peer found, a line each. May wait some seconds. Throws
  /// InputError where the configuration cannot work.
  virtual std::vector<std::string> check() { return {}; }

  /// The output that reports results to the senders of the messages, or null. From now on the
  /// senders' requests go to `requests`. Requires that `requests` outlives this.
  virtual Output* open_output(Requests& /*requests*/) { return nullptr; }
};

}  // namespace kelpie::live
