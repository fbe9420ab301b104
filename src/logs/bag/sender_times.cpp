// SPDX-License-Identifier: Apache-2.0
#include "bag/sender_times.hpp"

#include <cstdlib>

#include "bag/tuning.hpp"
#include "mavlink/definition.hpp"

namespace kelpie::bag {
namespace {

// Behind the last slash: "/mavlink/2/1/" and "ATTITUDE".
std::size_t name_at(std::string_view topic) {
  return topic.rfind('/') + 1;
}

}  // namespace

SenderTimes::Sender& SenderTimes::sender_of(std::string_view topic) {
  const std::string_view name = topic.substr(0, name_at(topic));
  const auto found = senders_.find(name);
  return found != senders_.end() ? found->second : senders_[std::string(name)];
}

void SenderTimes::expect(const std::string& topic) {
  const mavlink::Definition* const definition =
      mavlink::find_definition(topic.substr(name_at(topic)));
  if (definition == nullptr) {
    return;
  }
  const mavlink::Field* const us = definition->find("time_usec");
  if (definition->find("time_boot_ms") != nullptr ||
      (us != nullptr && us->kind == FieldKind::uint64)) {
    sender_of(topic).is_expected = true;
  }
}

bool SenderTimes::settle(std::string_view topic, std::int64_t receive_ns, StampReader& stamp) {
  if (!stamp.exists()) {
    return true;
  }
  Sender& sender = sender_of(topic);
  if (stamp.wraps() && !goes_on(sender, receive_ns, stamp)) {
    sender.untimed_ns = sender.untimed_ns.value_or(receive_ns);
    if (stamp.wraps_soon() && sender.is_expected &&
        receive_ns - *sender.untimed_ns <= kTuning.longest_untimed_ns) {
      return false;
    }
    stamp.place(0);
  }
  if (stamp.time_ns() < kTuning.longest_uptime_ns) {  // else a date
    sender.booted_ns = receive_ns - stamp.time_ns();
    sender.untimed_ns.reset();
  }
  return true;
}

bool SenderTimes::goes_on(const Sender& sender, std::int64_t receive_ns, StampReader& stamp) {
  if (!sender.booted_ns) {
    return false;
  }
  const std::int64_t near_ns = receive_ns - *sender.booted_ns;
  stamp.place(near_ns);
  return std::abs(stamp.time_ns() - near_ns) <= kTuning.wrap_margin_ns;
}

}  // namespace kelpie::bag
