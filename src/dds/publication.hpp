// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "dds/topic_end.hpp"

namespace kelpie::dds {

/// Publishes messages that are CDR already (bag::MessageBuilder makes them) on one topic. Use it
/// from one thread at a time.
class Publication {
 public:
  /// As for a Subscription. ROS 2's subscribers ask for reliable unless told otherwise, so the
  /// standard quality reaches all of them. Requires that `participant` outlives this.
  Publication(const Participant& participant, const std::string& topic, const std::string& type,
              const Quality& quality = Quality::standard());

  /// Sends a message with the four bytes of its encapsulation, stamped with this machine's time.
  /// Doesn't wait for a subscriber: who is slow loses the oldest. False, and counted, where the
  /// library refused it.
  bool publish(std::span<const std::byte> cdr);

  std::size_t subscribers() const;                    ///< That are connected now.
  std::uint64_t refused() const { return refused_; }  ///< Messages that weren't sent.
  std::vector<std::string> mismatches() const;        ///< As Subscription::mismatches.

 private:
  TopicEnd end_;
  Entity writer_;
  std::uint64_t refused_ = 0;
};

}  // namespace kelpie::dds
