// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "bag/message_type.hpp"
#include "bag/topic_columns.hpp"
#include "dds/message_queue.hpp"
#include "dds/participant.hpp"
#include "dds/subscription.hpp"
#include "live/configuration.hpp"
#include "live/transport.hpp"
#include "ros/node_settings.hpp"
#include "ros/publisher.hpp"

namespace kelpie::ros {

/// The topics that [log] names, as nodes of ROS 2 publish them: each is subscribed to once somebody
/// publishes it, with the type that this one has. What is wrong with that is told by health().
class TopicTransport final : public live::Transport {
 public:
  /// Joins the network. Throws InputError (file, topic) on a name that is none, and as
  /// dds::Participant does. The configuration has to outlive it.
  TopicTransport(const live::Configuration& configuration, const NodeSettings& settings);

  const std::vector<bag::Topic>& topics() const override { return topics_; }
  Got next(bag::Message& message, std::chrono::milliseconds most) override;
  live::TransportHealth health() const override;
  live::Output* open_output(live::Requests& requests) override;

  /// Waits until all topics are published, but at most three seconds; tells their types, and what
  /// is wrong. Throws InputError (file, column) on a type that hasn't the fields named.
  std::vector<std::string> check() override;

 private:
  using Clock = std::chrono::steady_clock;

  struct Wanted {
    std::unique_ptr<bag::TopicColumns> columns;  // bound for a look, and for nothing else
    std::string name;                            // as [log] has it
    std::string full_name;                       // on the network
    std::unique_ptr<dds::Subscription> subscription;
    std::size_t topic = 0;          // among topics_, where there is a subscription
    std::set<std::string> types{};  // with which it is published now
    std::uint64_t lost = 0;         // by subscriptions before this one
    std::string failure{};          // why nothing comes of these types
  };

  void search();
  void inspect(Wanted& wanted, const std::vector<dds::Endpoint>& endpoints);
  std::string mismatch_of(const Wanted& wanted, const std::string& type) const;
  void subscribe(Wanted& wanted, const std::string& type);
  bool is_current(std::size_t topic) const;
  bool all_connected() const;
  std::string fault_of(const Wanted& wanted) const;
  void execute(const std::vector<std::byte>& cdr);

  const live::Configuration& configuration_;
  NodeSettings settings_;
  bag::MessageDefinitions definitions_;
  dds::Participant participant_;
  dds::MessageQueue queue_;
  std::vector<bag::Topic> topics_;
  std::vector<Wanted> wanted_;
  std::vector<std::string> published_;  // names of topics, when last looked at
  dds::TopicSample held_;
  std::uint32_t count_ = 0;
  Clock::time_point searched_;
  std::unique_ptr<Publisher> publisher_;
  std::unique_ptr<dds::Subscription> commands_;
  live::Requests* requests_ = nullptr;
  std::string refused_;  // the last command, where it was none
};

}  // namespace kelpie::ros
