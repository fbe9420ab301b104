// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "dds/topic_end.hpp"

namespace kelpie::dds {

/// Publishes CDR messages (from bag::MessageBuilder) on one topic. For one thread at a time.
class Publication {
 public:
  /// Arguments as for a Subscription. ROS 2's subscribers request reliable by default, so the
  /// standard quality reaches them. Requires that `participant` outlives this.
  Publication(const Participant& participant, const std::string& topic, const std::string& type,
              const Quality& quality = Quality::standard());

  /// Sends a message, including the four bytes of encapsulation, stamped with this machine's time.
  /// Never waits: a slow subscriber loses the oldest messages. False, and counted, where the
  /// library refuses the message.
  bool publish(std::span<const std::byte> cdr);

  std::size_t subscribers() const;                    ///< Connected now.
  std::uint64_t refused() const { return refused_; }  ///< Messages not sent.
  std::vector<std::string> mismatches() const;        ///< As Subscription::mismatches.

 private:
  TopicEnd end_;
  Entity writer_;
  std::uint64_t refused_ = 0;
};

}  // namespace kelpie::dds
