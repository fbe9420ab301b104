// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "bag/bag.hpp"
#include "log/read_log.hpp"

namespace kelpie::live {

class Output;
class Requests;

/// What a transport knows of itself.
struct TransportHealth {
  std::size_t lost = 0;     ///< messages that were sent and didn't come, as far as it knows
  std::size_t damaged = 0;  ///< that came and weren't whole
  std::size_t unknown = 0;  ///< of a kind that has no definition
  /// What stands between it and messages now, a sentence each; said once where it is new.
  std::vector<std::string> faults{};
};

/// Where messages come from: raw, in whatever encoding they came. Used by one thread.
class Transport {
 public:
  /// What next() found.
  enum class Got {
    message,
    nothing,  ///< in the time given
    end,      ///< and nothing will ever come
  };

  Transport() = default;
  virtual ~Transport() = default;
  Transport(const Transport&) = delete;
  Transport(Transport&&) = delete;
  Transport& operator=(const Transport&) = delete;
  Transport& operator=(Transport&&) = delete;

  /// The topics met so far; next() may append to them, those there keep their index.
  virtual const std::vector<bag::Topic>& topics() const = 0;

  /// The next message, for which it waits at most so long. Its data are valid until the next call.
  virtual Got next(bag::Message& message, std::chrono::milliseconds most) = 0;

  /// For a recording, which waits for who reads it; none where messages come when they come.
  virtual std::optional<log::Reach> reach() const { return std::nullopt; }

  virtual TransportHealth health() const { return {}; }

  /// What it is and what it finds at its other end, in lines, for which it may wait some seconds.
  /// Throws InputError where nothing can come of it.
  virtual std::vector<std::string> check() { return {}; }

  /// Who is told what happens by the same way as messages come, or null. What is asked for there
  /// goes to `requests` from now on, which has to outlive this.
  virtual Output* open_output(Requests& /*requests*/) { return nullptr; }
};

}  // namespace kelpie::live
