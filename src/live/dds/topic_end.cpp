// SPDX-License-Identifier: Apache-2.0
#include "dds/topic_end.hpp"

#include <dds/dds.h>
#include <fmt/format.h>

#include <algorithm>

#include "core/text.hpp"
#include "dds/names.hpp"
#include "dds/raw_type.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::dds {
namespace {

// Endpoints matched with a reader or writer, in order.
std::vector<dds_instance_handle_t> matched_ends(std::int32_t end, bool publishes) {
  const auto ask = publishes ? dds_get_matched_subscriptions : dds_get_matched_publications;
  std::vector<dds_instance_handle_t> ends;
  dds_return_t count = ask(end, nullptr, 0);
  while (count > static_cast<dds_return_t>(ends.size())) {  // others may come meanwhile
    ends.resize(static_cast<std::size_t>(count));
    count = ask(end, ends.data(), ends.size());
  }
  ends.resize(static_cast<std::size_t>(std::max(count, 0)));
  std::ranges::sort(ends);
  return ends;
}

std::uint32_t last_policy(std::int32_t end, bool publishes) {
  if (publishes) {
    dds_offered_incompatible_qos_status_t status{};
    dds_get_offered_incompatible_qos_status(end, &status);
    return status.last_policy_id;
  }
  dds_requested_incompatible_qos_status_t status{};
  dds_get_requested_incompatible_qos_status(end, &status);
  return status.last_policy_id;
}

}  // namespace

TopicEnd::TopicEnd(const Participant& participant, const Endpoint& own)
    : participant_(participant), own_(own) {
  const std::string topic = dds_topic_name(own.topic);
  require(own.quality.depth >= 1, own.topic, "keeps at least one message");
  const std::string type = dds_type_name(own.type);
  own_.type = ros_type_name(type);  // "pkg/Type" has its "msg" from here on
  type_ = new_raw_type(type);
  // Takes over the type, and may replace it by a known equal type.
  const dds_entity_t created = dds_create_topic_sertype(participant.number(), topic.c_str(), &type_,
                                                        nullptr, nullptr, nullptr);
  if (created < 0) {
    free_raw_type(type_);
  }
  topic_ = Entity(created, own.topic + " couldn't be opened");
}

std::vector<std::string> TopicEnd::mismatches(std::int32_t end) const {
  const std::vector<dds_instance_handle_t> matched = matched_ends(end, own_.publishes);
  std::vector<std::string> found;
  for (const Endpoint& other : participant_.endpoints(own_.topic)) {
    if (other.publishes != own_.publishes && !std::ranges::binary_search(matched, other.id)) {
      const std::string text = mismatch(end, other);
      if (!text.empty() && std::ranges::find(found, text) == found.end()) {
        found.push_back(text);
        if (found.size() == kTuning.most_mismatches) {
          found.back() += "; further ones are left out";
          break;
        }
      }
    }
  }
  return found;
}

std::string TopicEnd::mismatch(std::int32_t end, const Endpoint& other) const {
  const std::string who =
      fmt::format("{}: a {} ", own_.topic, other.publishes ? "publisher" : "subscriber");
  if (other.type != own_.type) {
    return fmt::format("{}has type '{}', not '{}'", who, printable(other.type), own_.type);
  }
  if (other.quality.partition != own_.quality.partition) {
    return fmt::format("{}is in partition '{}', not '{}'", who, printable(other.quality.partition),
                       own_.quality.partition);
  }
  const Quality& offered = own_.publishes ? own_.quality : other.quality;
  const Quality& wanted = own_.publishes ? other.quality : own_.quality;
  const std::string_view verb = other.publishes ? "offers" : "asks for";
  const std::string_view own_verb = own_.publishes ? "is offered" : "is asked for";
  if (wanted.reliable && !offered.reliable) {
    return fmt::format("{}{} {}, while {} {} here (reliability)", who, verb,
                       other.quality.reliable ? "reliable" : "best effort",
                       own_.quality.reliable ? "reliable" : "best effort", own_verb);
  }
  if (wanted.transient_local && !offered.transient_local) {
    return fmt::format("{}{} {}, while {} {} here (durability)", who, verb,
                       other.quality.transient_local ? "transient local" : "volatile",
                       own_.quality.transient_local ? "transient local" : "volatile", own_verb);
  }
  // An endpoint found just now may not be matched yet: no policy is known then.
  const std::uint32_t policy = last_policy(end, own_.publishes);
  return policy == DDS_INVALID_QOS_POLICY_ID
             ? std::string()
             : fmt::format("{}has another quality of service ({})", who, policy_name(policy));
}

}  // namespace kelpie::dds
