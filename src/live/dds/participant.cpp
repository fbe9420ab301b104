// SPDX-License-Identifier: Apache-2.0
#include "dds/participant.hpp"

#include <dds/dds.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <map>
#include <mutex>
#include <string_view>
#include <unordered_map>

#include "core/text.hpp"
#include "dds/names.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::dds {
namespace {

// Packets that the library could not read, of all domains. A line of text for each would be a means
// to fill a disk.
std::atomic<std::uint64_t> damaged_packets{0};  // NOLINT: the library has one log per process

void hear_later(void* /*unused*/, const dds_log_data_t* said) {
  if (std::string_view(said->message).find("malformed packet") != std::string_view::npos) {
    ++damaged_packets;
  } else {
    static_cast<void>(std::fputs(said->message, stderr));
  }
}

// The library's log during its start: the only description of errors.
class StartLog {
 public:
  StartLog() : lock_(mutex()) { dds_set_log_sink(&StartLog::hear, this); }
  ~StartLog() { dds_set_log_sink(&hear_later, nullptr); }
  StartLog(const StartLog&) = delete;
  StartLog& operator=(const StartLog&) = delete;

  const std::string& text() const { return text_; }

 private:
  static std::mutex& mutex() {  // the library has one sink per process
    static std::mutex one;
    return one;
  }
  static void hear(void* log, const dds_log_data_t* said) {
    const std::string_view line = trimmed(std::string_view(
        said->message, std::string_view(said->message).find_last_not_of("\r\n") + 1));
    std::string& text = static_cast<StartLog*>(log)->text_;
    text += (text.empty() ? "" : "; ") + std::string(line);
  }

  std::unique_lock<std::mutex> lock_;
  std::string text_;
};

std::string said(const StartLog& log) {
  return log.text().empty() ? std::string() : " (" + log.text() + ")";
}

dds_entity_t create_domain(const Network& network) {
  return dds_create_domain(network.domain, cyclone_configuration(network).c_str());
}

// The library reports an invalid configuration neither by a code nor by a message of its own.
bool can_do_without_configuration(Network network) {
  network.configuration.clear();
  const dds_entity_t domain = create_domain(network);
  return domain > 0 && dds_delete(domain) == DDS_RETCODE_OK;
}

Entity domain_of(const Network& network, const StartLog& log) {
  const dds_entity_t domain = create_domain(network);
  const std::string name = "DDS domain " + std::to_string(network.domain);
  if (domain == DDS_RETCODE_PRECONDITION_NOT_MET) {
    throw Failure(name + ": this process has a participant of it already");
  }
  const std::string why = said(log);
  if (domain < 0 && !network.configuration.empty() && can_do_without_configuration(network)) {
    throw InputError("configuration of Cyclone DDS", "is refused" + why);
  }
  return {domain, name + " couldn't be opened" + why};
}

}  // namespace

Entity::Entity(std::int32_t created, const std::string& what) : number_(created) {
  if (created < 0) {
    throw Failure(what + ": " + dds_strretcode(created));
  }
}

Entity::~Entity() {
  if (number_ > 0) {
    dds_delete(number_);
  }
}

// The present endpoints of ROS 2's topics, kept up to date by the changes that the library's two
// built-in readers hand out.
class Participant::Directory {
 public:
  explicit Directory(const Entity& participant)
      : publications_(reader(participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION)),
        subscriptions_(reader(participant, DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION)) {
    dds_get_guid(participant.number(), &self_);
  }

  std::vector<Endpoint> endpoints(const std::string& topic) {
    const std::lock_guard lock(mutex_);
    update();
    std::vector<Endpoint> found;
    for (auto [at, end] = by_topic_.equal_range(topic); at != end; ++at) {
      found.push_back(at->second);
    }
    return found;
  }

  std::vector<std::string> published() {
    const std::lock_guard lock(mutex_);
    update();
    std::vector<std::string> topics;
    for (const auto& [topic, endpoint] : by_topic_) {
      if (endpoint.publishes && !endpoint.own && (topics.empty() || topics.back() != topic)) {
        topics.push_back(topic);
      }
    }
    return topics;
  }

  std::uint64_t revision() {
    const std::lock_guard lock(mutex_);
    update();
    return revision_;
  }

 private:
  using ByTopic = std::multimap<std::string, Endpoint>;

  static Entity reader(const Entity& participant, dds_entity_t topic) {
    return {dds_create_reader(participant.number(), topic, nullptr, nullptr),
            "the list of topics couldn't be opened"};
  }

  void update() {
    take(publications_, true);
    take(subscriptions_, false);
  }

  void take(const Entity& list, bool publishes) {
    // One size for all calls: Cyclone DDS 0.10 fills as many pointers as its largest loan had.
    constexpr std::size_t kStep = 64;
    dds_return_t count = 0;
    do {
      std::array<void*, kStep> samples{};
      std::array<dds_sample_info_t, kStep> infos{};
      count = dds_take(list.number(), samples.data(), infos.data(), kStep, kStep);
      for (dds_return_t i = 0; i < count; ++i) {
        const auto index = static_cast<std::size_t>(i);
        change(infos[index], *static_cast<const dds_builtintopic_endpoint_t*>(samples[index]),
               publishes);
      }
      if (count > 0) {
        dds_return_loan(list.number(), samples.data(), count);
      }
    } while (count == static_cast<dds_return_t>(kStep));
  }

  void change(const dds_sample_info_t& info, const dds_builtintopic_endpoint_t& found,
              bool publishes) {
    const auto known = by_handle_.find(info.instance_handle);
    if (known != by_handle_.end()) {
      by_topic_.erase(known->second);
      by_handle_.erase(known);
      ++revision_;
    }
    if (info.instance_state != DDS_ALIVE_INSTANCE_STATE || !info.valid_data) {
      return;
    }
    const std::string topic = ros_topic_name(found.topic_name);
    const std::string type = ros_type_name(found.type_name);
    if (topic.empty() || type.empty()) {
      return;
    }
    const auto place =
        by_topic_.insert({topic,
                          {.publishes = publishes,
                           .own = std::ranges::equal(found.participant_key.v, self_.v),
                           .topic = topic,
                           .type = type,
                           .quality = quality_of(found.qos),
                           .id = info.instance_handle}});
    by_handle_.emplace(info.instance_handle, place);
    ++revision_;
  }

  std::mutex mutex_;
  dds_guid_t self_{};
  Entity publications_;
  Entity subscriptions_;
  ByTopic by_topic_;
  std::unordered_map<dds_instance_handle_t, ByTopic::iterator> by_handle_;
  std::uint64_t revision_ = 0;
};

Participant::Participant(const Network& network) {
  const StartLog log;
  domain_ = domain_of(network, log);
  participant_ =
      Entity(dds_create_participant(network.domain, nullptr, nullptr),
             "DDS domain " + std::to_string(network.domain) + " couldn't be joined" + said(log));
  directory_ = std::make_unique<Directory>(participant_);
}

Participant::~Participant() = default;

std::vector<Endpoint> Participant::endpoints(const std::string& topic) const {
  return directory_->endpoints(topic);
}

std::vector<std::string> Participant::published() const {
  return directory_->published();
}

std::uint64_t Participant::damaged() {
  return damaged_packets;
}

std::uint64_t Participant::revision() const {
  return directory_->revision();
}

}  // namespace kelpie::dds
