// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bag/bag.hpp"
#include "dds/publication.hpp"
#include "ros/node_settings.hpp"

namespace kelpie::ros {

/// Publishes a recording in place of the vehicle, at the times at which its messages were received.
class Player {
 public:
  /// Joins the network. Throws as dds::Participant does; requires that `bag` outlives this.
  Player(bag::BagReader& bag, const NodeSettings& settings, double speed);

  /// Publishes all messages, the first once somebody subscribes, or after three seconds; until
  /// `is_over` says so, which is asked some 20 times per second. Throws as BagReader::next does.
  void play(const std::function<bool()>& is_over);

  std::size_t messages() const { return messages_; }  ///< that were published
  /// Topics that can't be, and why.
  const std::vector<std::string>& left_out() const { return left_out_; }

 private:
  void open_publications();
  bool has_subscriber() const;

  bag::BagReader& bag_;
  NodeSettings settings_;
  double speed_;
  dds::Participant participant_;
  std::vector<std::unique_ptr<dds::Publication>> publications_;  // per topic; null: left out
  std::vector<std::string> left_out_;
  std::size_t messages_ = 0;
};

}  // namespace kelpie::ros
