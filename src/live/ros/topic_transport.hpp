// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "bag/topic_columns.hpp"
#include "dds/message_queue.hpp"
#include "dds/participant.hpp"
#include "dds/subscription.hpp"
#include "live/configuration.hpp"
#include "live/transport.hpp"
#include "ros/node_settings.hpp"
#include "ros/publisher.hpp"

namespace kelpie::ros {

/// The topics that [log] names, from nodes of ROS 2. A topic is subscribed to as soon as it has a
/// publisher, with the publisher's type. health() describes the obstacles.
class TopicTransport final : public live::Transport {
 public:
  /// Joins the network. Throws InputError (file, topic) on an invalid name, and as dds::Participant
  /// does. Requires that the configuration outlives this.
  TopicTransport(const live::Configuration& configuration, const NodeSettings& settings);

  const std::vector<bag::Topic>& topics() const override { return topics_; }
  Got next(bag::Message& message, std::chrono::milliseconds timeout) override;
  live::TransportHealth health() const override;
  live::Output* open_output(live::Requests& requests) override;

  /// Waits for publishers of all topics, at most Tuning::longest_check; lists types and faults.
  /// Throws InputError (file, column) on a type without the named fields.
  std::vector<std::string> check() override;

 private:
  using Clock = std::chrono::steady_clock;

  struct Wanted {
    std::unique_ptr<bag::TopicColumns> columns;  // bound to check a type
    std::string name;                            // in [log]
    std::string full_name;                       // on the network
    std::unique_ptr<dds::Subscription> subscription;
    std::size_t topic = 0;          // of the subscription: index in topics_
    std::set<std::string> types{};  // of the present publishers
    std::uint64_t lost = 0;         // by earlier subscriptions
    std::string failure{};          // why these types cannot be used
    std::string nearest{};          // topic with a publisher and a similar name, as a question
  };

  void search();
  void inspect(Wanted& wanted);
  std::string mismatch_of(const Wanted& wanted, const std::string& type) const;
  void subscribe(Wanted& wanted, const std::string& type);
  bool is_current(std::size_t topic) const;
  bool all_connected() const;
  static std::string fault_of(const Wanted& wanted);
  void refuse_long_commands();
  void execute(const std::vector<std::byte>& cdr);
  void allocate(const std::vector<std::byte>& cdr);

  const live::Configuration& configuration_;
  NodeSettings settings_;
  bag::MessageDefinitions definitions_;
  dds::Participant participant_;
  dds::MessageQueue queue_;
  std::vector<bag::Topic> topics_;
  std::vector<Wanted> wanted_;
  dds::TopicSample held_;
  std::uint32_t count_ = 0;
  Clock::time_point searched_;
  std::uint64_t searched_revision_ = 0;
  std::unique_ptr<Publisher> publisher_;
  std::unique_ptr<dds::Subscription> commands_;
  std::unique_ptr<dds::Subscription> accelerations_;         // wanted
  std::unique_ptr<bag::TopicColumns> acceleration_columns_;  // of a twist's axes
  live::Requests* requests_ = nullptr;
  std::uint64_t commands_too_long_ = 0;
  std::string refused_;  // why the last command was refused
};

}  // namespace kelpie::ros
