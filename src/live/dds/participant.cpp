// SPDX-License-Identifier: Apache-2.0
#include "dds/participant.hpp"

#include <dds/dds.h>

#include <algorithm>
#include <mutex>
#include <string_view>

#include "core/text.hpp"
#include "dds/names.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::dds {
namespace {

// The library's log during its start: the only description of errors.
class StartLog {
 public:
  StartLog() : lock_(mutex()) { dds_set_log_sink(&StartLog::hear, this); }
  ~StartLog() { dds_set_log_sink(nullptr, nullptr); }
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
  return Entity(domain, name + " couldn't be opened" + why);
}

Entity builtin_reader(const Entity& participant, dds_entity_t topic) {
  return Entity(dds_create_reader(participant.number(), topic, nullptr, nullptr),
                "the list of topics couldn't be opened");
}

// Adds the present endpoints of a built-in list, of publishers or of subscribers.
void list_endpoints(const Entity& list, bool publishes, const dds_guid_t& self,
                    std::vector<Endpoint>& endpoints) {
  std::vector<void*> samples;
  std::vector<dds_sample_info_t> infos;
  std::size_t count = 0;
  for (std::size_t room = 256; count == samples.size(); room *= 2) {
    samples.assign(room, nullptr);
    infos.resize(room);
    const dds_return_t read = dds_read_mask(
        list.number(), samples.data(), infos.data(), room, static_cast<std::uint32_t>(room),
        DDS_ANY_SAMPLE_STATE | DDS_ANY_VIEW_STATE | DDS_ALIVE_INSTANCE_STATE);
    if (read <= 0) {
      return;
    }
    count = static_cast<std::size_t>(read);
    if (count == room) {
      dds_return_loan(list.number(), samples.data(), read);
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    const auto& found = *static_cast<const dds_builtintopic_endpoint_t*>(samples[i]);
    const std::string topic = infos[i].valid_data ? ros_topic_name(found.topic_name) : "";
    const std::string type = infos[i].valid_data ? ros_type_name(found.type_name) : "";
    if (!topic.empty() && !type.empty()) {
      endpoints.push_back({.publishes = publishes,
                           .own = std::ranges::equal(found.participant_key.v, self.v),
                           .topic = topic,
                           .type = type,
                           .quality = quality_of(found.qos),
                           .id = infos[i].instance_handle});
    }
  }
  dds_return_loan(list.number(), samples.data(), static_cast<std::int32_t>(count));
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

Participant::Participant(const Network& network) {
  const StartLog log;
  domain_ = domain_of(network, log);
  participant_ =
      Entity(dds_create_participant(network.domain, nullptr, nullptr),
             "DDS domain " + std::to_string(network.domain) + " couldn't be joined" + said(log));
  publications_ = builtin_reader(participant_, DDS_BUILTIN_TOPIC_DCPSPUBLICATION);
  subscriptions_ = builtin_reader(participant_, DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION);
}

std::vector<Endpoint> Participant::endpoints() const {
  dds_guid_t self{};
  dds_get_guid(participant_.number(), &self);
  std::vector<Endpoint> endpoints;
  list_endpoints(publications_, true, self, endpoints);
  list_endpoints(subscriptions_, false, self, endpoints);
  return endpoints;
}

}  // namespace kelpie::dds
