// SPDX-License-Identifier: Apache-2.0
#include "ros/topic_transport.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "live/requests.hpp"
#include "ros/text_message.hpp"
#include "ros/tuning.hpp"

namespace kelpie::ros {
namespace {

constexpr std::size_t kCommand = static_cast<std::size_t>(-1);  // in place of a topic's index
constexpr std::size_t kWanted = static_cast<std::size_t>(-2);   // the same
constexpr const char* kWantedType = "geometry_msgs/msg/AccelStamped";

std::int64_t time_or(std::int64_t time_ns, std::int64_t otherwise) {
  return time_ns > 0 && time_ns <= bag::Message::kLatestNs ? time_ns : otherwise;
}

}  // namespace

TopicTransport::TopicTransport(const live::Configuration& configuration,
                               const NodeSettings& settings)
    : configuration_(configuration),
      settings_(settings),
      definitions_(configuration.log.messages),
      participant_(settings.network) {
  for (auto& columns : bag::columns_by_topic(configuration.columns())) {
    Wanted& wanted = wanted_.emplace_back();
    wanted.name = columns->topic();
    wanted.columns = std::move(columns);
    try {
      wanted.full_name = settings.names.full_name(wanted.name);
    } catch (const InputError& error) {
      configuration.log.refuse_column(wanted.columns->columns().front().name, error.what());
    }
  }
}

live::Transport::Got TopicTransport::next(bag::Message& message,
                                          std::chrono::milliseconds timeout) {
  const auto pause =
      all_connected() ? Clock::duration(kTuning.between_checks) : kTuning.between_searches;
  if (Clock::now() - searched_ >= pause) {
    search();
  }
  refuse_long_commands();
  if (!queue_.pop(held_, timeout)) {
    return Got::nothing;
  }
  if (held_.topic == kCommand) {
    execute(held_.cdr);
    return Got::nothing;
  }
  if (held_.topic == kWanted) {
    allocate(held_.cdr);
    return Got::nothing;
  }
  if (!is_current(held_.topic)) {
    return Got::nothing;  // of a replaced subscription
  }
  message = {.topic = held_.topic,
             .receive_ns = held_.receive_ns,
             .publish_ns = time_or(held_.source_ns, held_.receive_ns),
             .sequence = count_++,
             .data = held_.cdr};
  return Got::message;
}

bool TopicTransport::is_current(std::size_t topic) const {
  return std::ranges::any_of(wanted_, [&](const Wanted& one) {
    return one.subscription != nullptr && one.topic == topic;
  });
}

bool TopicTransport::all_connected() const {
  return std::ranges::all_of(wanted_, [](const Wanted& one) {
    return one.subscription != nullptr && one.subscription->publishers() > 0;
  });
}

// Nothing to do while no endpoint comes or goes.
void TopicTransport::search() {
  searched_ = Clock::now();
  const std::uint64_t revision = participant_.revision();
  if (std::exchange(searched_revision_, revision) != revision) {
    std::ranges::for_each(wanted_, [&](Wanted& wanted) { inspect(wanted); });
  }
}

// Subscribes with the first type that has the named fields, and keeps this type while it has a
// publisher. Messages of other types are of no use, nor in a recording.
void TopicTransport::inspect(Wanted& wanted) {
  std::set<std::string> types;
  for (const dds::Endpoint& endpoint : participant_.endpoints(wanted.full_name)) {
    if (endpoint.publishes && !endpoint.own) {
      types.insert(endpoint.type);
    }
  }
  wanted.nearest = types.empty() && !wanted.subscription
                       ? did_you_mean(wanted.full_name, participant_.published())
                       : std::string();
  if (types == wanted.types) {
    return;
  }
  wanted.types = types;
  wanted.failure.clear();
  if (wanted.subscription && types.contains(topics_[wanted.topic].type)) {
    return;
  }
  for (const std::string& type : types) {
    const std::string why = mismatch_of(wanted, type);
    if (why.empty()) {
      subscribe(wanted, type);
      return;
    }
    wanted.failure = wanted.name + " cannot be used: " + why;
  }
}

std::string TopicTransport::mismatch_of(const Wanted& wanted, const std::string& type) const {
  try {
    wanted.columns->bind({.name = wanted.name, .type = type}, definitions_,
                         configuration_.log.clock);
    return {};
  } catch (const InputError& error) {
    return error.what();
  }
}

void TopicTransport::subscribe(Wanted& wanted, const std::string& type) {
  wanted.failure.clear();
  if (topics_.size() == kTuning.most_topics) {
    wanted.failure = wanted.name + ": too many changes of type; restart kelpie to subscribe again";
    return;
  }
  if (wanted.subscription) {
    wanted.lost += wanted.subscription->lost();
    wanted.subscription.reset();
    queue_.forget(wanted.topic);
  }
  try {
    wanted.subscription = std::make_unique<dds::Subscription>(
        participant_, wanted.full_name, type, settings_.subscribed, queue_, topics_.size());
  } catch (const std::exception& error) {  // the type's name is up to the publisher
    wanted.failure = error.what();
    return;
  }
  wanted.topic = topics_.size();
  topics_.push_back({.name = wanted.name, .type = type});
}

std::string TopicTransport::fault_of(const Wanted& wanted) {
  if (!wanted.failure.empty()) {
    return wanted.failure;
  }
  if (!wanted.types.empty()) {
    return {};
  }
  const std::string name =
      wanted.name == wanted.full_name ? wanted.name : wanted.name + " (" + wanted.full_name + ")";
  return wanted.subscription ? name + ": no publisher any more"
                             : name + ": no publisher yet" + wanted.nearest;
}

live::TransportHealth TopicTransport::health() const {
  live::TransportHealth health{.lost = queue_.lost(), .damaged = dds::Participant::damaged()};
  for (const Wanted& wanted : wanted_) {
    health.lost += wanted.lost;
    if (const std::string fault = fault_of(wanted); !fault.empty()) {
      health.faults.push_back(fault);
    }
    if (wanted.subscription) {
      health.lost += wanted.subscription->lost();
      std::ranges::move(wanted.subscription->mismatches(), std::back_inserter(health.faults));
    }
  }
  if (publisher_) {
    std::ranges::move(publisher_->mismatches(), std::back_inserter(health.faults));
    std::ranges::move(commands_->mismatches(), std::back_inserter(health.faults));
    std::ranges::move(accelerations_->mismatches(), std::back_inserter(health.faults));
  }
  if (!refused_.empty()) {
    health.faults.push_back(refused_);
  }
  return health;
}

live::Output* TopicTransport::open_output(live::Requests& requests) {
  requests_ = &requests;
  publisher_ = std::make_unique<Publisher>(participant_, settings_, configuration_);
  commands_ = std::make_unique<dds::Subscription>(
      participant_, settings_.names.full_name("~/command"), kTextType, settings_.commands, queue_,
      kCommand, kTuning.command_bytes);
  const std::string wanted = settings_.names.full_name("~/wanted");
  acceleration_columns_ = std::make_unique<bag::TopicColumns>(wanted);
  for (const char* const field :
       {"linear.x", "linear.y", "linear.z", "angular.x", "angular.y", "angular.z"}) {
    acceleration_columns_->ask(bag::parse_column(wanted + ":accel." + field));
  }
  acceleration_columns_->bind({.name = wanted, .type = kWantedType}, definitions_,
                              bag::Clock::receive);
  accelerations_ =
      std::make_unique<dds::Subscription>(participant_, wanted, kWantedType, settings_.subscribed,
                                          queue_, kWanted, kTuning.wanted_bytes);
  return publisher_.get();
}

void TopicTransport::allocate(const std::vector<std::byte>& cdr) {
  const std::string topic = acceleration_columns_->topic();
  try {
    acceleration_columns_->begin({.topic = kWanted,
                                  .receive_ns = held_.receive_ns,
                                  .publish_ns = held_.receive_ns,
                                  .sequence = 0,
                                  .data = cdr});
    acceleration_columns_->decoder().visit(cdr, *acceleration_columns_);
    const std::string why_not = publisher_->allocate(acceleration_columns_->values());
    refused_ = why_not.empty() ? "" : topic + ": " + why_not;
  } catch (const InputError& error) {
    refused_ = topic + ": " + error.what();
  }
}

void TopicTransport::refuse_long_commands() {
  const std::uint64_t too_long = commands_ ? commands_->too_long() : 0;
  if (std::exchange(commands_too_long_, too_long) != too_long) {
    refused_ = fmt::format("{}: a command of more than {} bytes was refused",
                           settings_.names.full_name("~/command"), kTuning.command_bytes);
  }
}

void TopicTransport::execute(const std::vector<std::byte>& cdr) {
  const std::string topic = settings_.names.full_name("~/command");
  const std::optional<std::string> text = text_of(cdr);
  if (!text) {
    refused_ = topic + ": a message that isn't of type " + kTextType;
    return;
  }
  const std::string word(trimmed(*text));
  try {
    requests_->push(live::parse_request(word, ""));
    refused_.clear();
  } catch (const InputError& error) {
    refused_ =
        fmt::format("{}: '{}' {}", topic, printable(word, kTuning.command_letters), error.what());
  }
}

std::vector<std::string> TopicTransport::check() {
  const Clock::time_point end = Clock::now() + kTuning.longest_check;
  do {
    std::this_thread::sleep_for(kTuning.check_step);
    search();
  } while (!all_connected() && Clock::now() < end);
  std::vector<std::string> lines{
      fmt::format("topics of ROS 2 in DDS domain {}", settings_.network.domain)};
  for (const Wanted& wanted : wanted_) {
    if (!wanted.failure.empty()) {
      const auto at_fault =
          std::ranges::find_if(wanted.columns->columns(), [&](const bag::ColumnName& column) {
            return wanted.failure.find(column.name) != std::string::npos;
          });
      configuration_.log.refuse_column(
          at_fault == wanted.columns->columns().end() ? wanted.name : at_fault->name,
          wanted.failure);
    }
    if (wanted.subscription) {
      lines.push_back(fmt::format("{}: {}", wanted.name, topics_[wanted.topic].type));
    }
  }
  std::ranges::move(health().faults, std::back_inserter(lines));
  return lines;
}

}  // namespace kelpie::ros
