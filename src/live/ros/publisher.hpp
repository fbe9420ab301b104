// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bag/message_builder.hpp"
#include "dds/publication.hpp"
#include "live/configuration.hpp"
#include "live/output.hpp"
#include "ros/node_settings.hpp"

namespace kelpie::ros {

/// A topic and its next message.
struct TopicWriter {
  /// `topic` is a node's name ("~/prediction"). Throws as dds::Publication does.
  TopicWriter(const dds::Participant& participant, const NodeSettings& settings,
              const std::string& topic, const std::string& type);

  void send() { publication.publish(message.bytes()); }

  bag::MessageBuilder message;
  dds::Publication publication;
};

/// Publishes predictions, health and events to nodes of ROS 2 (howto/live.md#what-it-publishes).
/// Never waits: a slow subscriber loses the oldest messages.
class Publisher final : public live::Output {
 public:
  /// Requires that participant and configuration outlive this. Throws as dds::Publication does.
  Publisher(const dds::Participant& participant, const NodeSettings& settings,
            const live::Configuration& configuration);

  bool wants_predictions() const override { return true; }
  void predicted(const live::PredictedSample& sample) override;
  void reckoned(const live::ReckonedSample& sample) override;
  void health(const live::Health& health) override;
  void event(const std::string& line) override;

  /// Publishes commands for wanted accelerations, in the order of the axes of a twist; NaN counts
  /// as 0. Returns why not; empty: published.
  std::string allocate(std::span<const double> wanted);

  std::vector<std::string> mismatches() const;  ///< Of all topics, as Subscription::mismatches.

 private:
  void publish_acceleration(const live::PredictedSample& sample);
  void publish_axes(std::span<const Prediction> predictions);
  void publish_coefficients(const live::Health& health);
  void publish_authority(const live::Effectiveness& effectiveness);
  void publish_diagnostics(const live::Health& health);

  const live::Configuration& configuration_;
  std::string node_;                                       // full name
  std::vector<std::optional<std::size_t>> accelerations_;  // axis of each target
  double widths_per_sigma_;                                // of half an interval
  TopicWriter prediction_;
  TopicWriter velocity_;
  TopicWriter axes_;
  TopicWriter coefficients_;
  TopicWriter authority_;
  TopicWriter allocation_;
  TopicWriter diagnostics_;
  TopicWriter events_;
  std::vector<double> values_;
  live::Health before_;
  std::shared_ptr<const live::Effectiveness> effectiveness_;
};

}  // namespace kelpie::ros
