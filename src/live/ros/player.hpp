// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bag/open_bag.hpp"
#include "dds/publication.hpp"
#include "ros/node_settings.hpp"

namespace kelpie::ros {

/// Publishes a recording in place of the vehicle, at the times of reception.
class Player {
 public:
  /// Joins the network. Throws as dds::Participant does. Requires that `bag` outlives this.
  Player(bag::MessageReader& bag, const NodeSettings& settings, double speed);

  /// Publishes all messages, from the first subscription on or after Tuning::longest_wait. Stops
  /// when `is_over` returns true (called some 20 times per second). Throws as MessageReader::next
  /// does.
  void play(const std::function<bool()>& is_over);

  std::size_t messages() const { return messages_; }  ///< published
  /// Topics that cannot be published, with reasons.
  const std::vector<std::string>& left_out() const { return left_out_; }

 private:
  void open_publications();
  bool has_subscriber() const;

  bag::MessageReader& bag_;
  NodeSettings settings_;
  double speed_;
  dds::Participant participant_;
  std::vector<std::unique_ptr<dds::Publication>> publications_;  // per topic; null: left out
  std::vector<std::string> left_out_;
  std::size_t messages_ = 0;
};

}  // namespace kelpie::ros
