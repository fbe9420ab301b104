// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include "bag/bag.hpp"
#include "log/read_log.hpp"

namespace kelpie::live {

/// Where messages come from: raw, in CDR, whatever they came by. Used by one thread.
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
};

}  // namespace kelpie::live
