// SPDX-License-Identifier: Apache-2.0
#include "bag/inspect.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

#include "bag/autopilot_state.hpp"
#include "bag/decoding.hpp"
#include "bag/sender_times.hpp"
#include "bag/statistics.hpp"
#include "bag/tuning.hpp"
#include "core/quantile.hpp"
#include "core/seconds.hpp"

namespace kelpie::bag {
namespace {

// The values of one leaf: of all its elements, and of each of the first ones.
class LeafInspector {
 public:
  void add(std::span<const std::uint32_t> indices, double value) {
    all_.add(value);
    if (indices.size() == 1 && indices[0] < FieldRange::kMostElements) {
      elements_.resize(std::max<std::size_t>(elements_.size(), indices[0] + 1));
      elements_[indices[0]].add(value);
    }
  }

  FieldRange range(const MessageType::Leaf& leaf) const {
    FieldRange range{.path = leaf.path,
                     .low = all_.low(),
                     .high = all_.high(),
                     .finite = all_.finite(),
                     .not_finite = all_.not_finite(),
                     .unit = leaf.unit,
                     .noise = elements_.empty() ? all_.noise() : std::nullopt};
    for (const Statistics& element : elements_) {
      range.elements.push_back(
          {.low = element.low(), .high = element.high(), .finite = element.finite()});
      range.noise = std::max(range.noise, element.noise());  // none is the least
    }
    return range;
  }

 private:
  Statistics all_;
  std::vector<Statistics> elements_;
};

// Looks at the messages of one topic.
class TopicInspector final : public NumberVisitor {
 public:
  // Takes the leaves of the topic from those that are left.
  TopicInspector(const Topic& topic, const MessageDefinitions& definitions,
                 std::size_t& leaves_left) {
    report_.name = topic.name;
    report_.type = topic.type;
    try {
      require(leaves_left > 0, topic.name,
              fmt::format("the topics before have more than {} fields", kTuning.most_leaves));
      decoder_ = Decoder(topic, definitions);
      leaves_left -= std::min(leaves_left, decoder_.type().leaves.size());
      stamp_ = StampReader(decoder_);
      is_decoded_ = true;
    } catch (const InputError& error) {
      report_.not_decoded = error.what();
    }
    leaves_.resize(decoder_.type().leaves.size());
  }

  void add(MessageReader& bag, const Message& message, SenderTimes& times) {
    received_ns_.push_back(message.receive_ns);
    if (is_decoded_ && decode(bag, message, decoder_, *this) && stamp_.exists() &&
        times.settle(report_.name, message.receive_ns, stamp_)) {
      offsets_s_.push_back(seconds(message.receive_ns - stamp_.time_ns()));
    }
  }

  bool wants(std::size_t leaf) const override { return !decoder_.type().leaves[leaf].is_bulk; }
  void number(std::size_t leaf, std::span<const std::uint32_t> indices, double value) override {
    stamp_.number(leaf, value);
    leaves_[leaf].add(indices, value);
  }

  std::optional<std::pair<std::int64_t, std::int64_t>> span_ns() {
    std::ranges::sort(received_ns_);
    return received_ns_.empty()
               ? std::nullopt
               : std::optional(std::pair(received_ns_.front(), received_ns_.back()));
  }

  // Requires span_ns() called.
  TopicReport finished(std::int64_t start_ns) {
    report_.messages = received_ns_.size();
    measure_times(start_ns);
    if (!offsets_s_.empty()) {
      const auto [low, high] = std::ranges::minmax(offsets_s_);
      report_.clock_offset = {.median_s = quantile(offsets_s_, 0.5), .low_s = low, .high_s = high};
    }
    for (std::size_t leaf = 0; leaf < leaves_.size(); ++leaf) {
      FieldRange range = leaves_[leaf].range(decoder_.type().leaves[leaf]);
      if (range.finite + range.not_finite > 0) {
        report_.fields.push_back(std::move(range));
      }
    }
    return std::move(report_);
  }

 private:
  void measure_times(std::int64_t start_ns) {
    if (received_ns_.size() < 2) {
      return;
    }
    const double span = seconds(received_ns_.back() - received_ns_.front());
    report_.rate_hz = span > 0.0 ? static_cast<double>(received_ns_.size() - 1) / span : 0.0;
    for (std::size_t i = 1; i < received_ns_.size(); ++i) {
      const double gap = seconds(received_ns_[i] - received_ns_[i - 1]);
      if (gap > report_.longest_gap_s) {
        report_.longest_gap_s = gap;
        report_.longest_gap_at_s = seconds(received_ns_[i - 1] - start_ns);
      }
    }
  }

  TopicReport report_;
  bool is_decoded_ = false;
  Decoder decoder_;
  StampReader stamp_;
  std::vector<LeafInspector> leaves_;
  std::vector<std::int64_t> received_ns_;
  std::vector<double> offsets_s_;
};

using Inspectors = std::vector<std::unique_ptr<TopicInspector>>;

Inspectors look_at(MessageReader& bag, const MessageDefinitions& definitions,
                   AutopilotReport& report) {
  Inspectors topics;
  AutopilotState autopilot;
  SenderTimes times;
  std::int64_t before_ns = 0;
  std::size_t leaves_left = kTuning.most_leaves;
  const auto meet_topics = [&] {
    for (std::size_t k = topics.size(); k < bag.topics().size(); ++k) {
      topics.push_back(std::make_unique<TopicInspector>(bag.topics()[k], definitions, leaves_left));
    }
  };
  for (Message message; bag.next(message);) {
    meet_topics();
    topics[message.topic]->add(bag, message, times);
    autopilot.hear(bag.topics(), message);
    if (before_ns > 0 && message.receive_ns > before_ns && !autopilot.is_disarmed()) {
      report.armed_s += seconds(message.receive_ns - before_ns);
    }
    before_ns = message.receive_ns;
  }
  meet_topics();
  report.parameters = autopilot.parameters();
  report.was_armed = autopilot.was_armed();
  report.was_disarmed = autopilot.was_disarmed();
  return topics;
}

}  // namespace

BagReport inspect_bag(MessageReader& bag, const MessageDefinitions& definitions) {
  BagReport report;
  const Inspectors topics = look_at(bag, definitions, report.autopilot);
  std::int64_t first_ns = std::numeric_limits<std::int64_t>::max();
  std::int64_t last_ns = 0;
  for (const auto& topic : topics) {
    if (const auto span = topic->span_ns()) {
      first_ns = std::min(first_ns, span->first);
      last_ns = std::max(last_ns, span->second);
    }
  }
  for (const auto& topic : topics) {
    report.topics.push_back(topic->finished(first_ns));
    report.messages += report.topics.back().messages;
  }
  if (report.messages > 0) {
    report.start_ns = first_ns;
    report.duration_s = seconds(last_ns - first_ns);
  }
  std::ranges::sort(report.topics, {}, &TopicReport::name);
  report.losses = bag.losses();
  report.loss_count = bag.loss_count();
  report.passed_over = bag.passed_over();
  report.left_out = bag.left_out();
  return report;
}

}  // namespace kelpie::bag
