// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "live/configuration.hpp"
#include "web/feed.hpp"

namespace kelpie::web {

/// Server-sent events for one browser, with data in JSON:
///
///     plan     axes with units, fields of the health for the page's tables; once, first
///     samples  [[t, measured, predicted, lower, upper, … of the next axis], …], null: unknown
///     said     [[ms since 1970, text], …]
///     health   fields by key (live/health_table.hpp), alerts, coefficients
///     end      the recording has ended; nothing follows
///
/// The first text contains all that the feed keeps, so a browser that reconnects starts anew. For
/// one thread.
class EventStream {
 public:
  /// Requires that both outlive this.
  EventStream(const live::Configuration& configuration, const Feed& feed)
      : configuration_(configuration), feed_(feed) {}

  std::string next();  ///< New events since the previous call; may be empty.

 private:
  const live::Configuration& configuration_;
  const Feed& feed_;
  bool has_begun_ = false;
  bool has_said_end_ = false;
  std::uint64_t next_row_ = 0;
  std::uint64_t next_line_ = 0;
  std::shared_ptr<const live::Health> health_;
};

}  // namespace kelpie::web
