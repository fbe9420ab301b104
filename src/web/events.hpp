// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "live/configuration.hpp"
#include "web/feed.hpp"

namespace kelpie::web {

/// What a browser is told, as server-sent events whose data is JSON:
///
///     plan     axes and their units, what was configured; once, first
///     samples  [[t, measured, predicted, lower, upper, … of the next axis], …], null: none
///     said     [[ms since 1970, text], …]
///     health   all counts and faults, the axes with R², baselines and coefficients
///
/// One per reader, used by one thread. Its first text has all that is kept, so who comes again
/// begins anew.
class EventStream {
 public:
  /// Both have to outlive it.
  EventStream(const live::Configuration& configuration, const Feed& feed)
      : configuration_(configuration), feed_(feed) {}

  /// What is new since the call before; may be empty.
  std::string next();

 private:
  const live::Configuration& configuration_;
  const Feed& feed_;
  bool has_begun_ = false;
  std::uint64_t next_row_ = 0;
  std::uint64_t next_line_ = 0;
  std::shared_ptr<const live::Health> health_;
};

}  // namespace kelpie::web
