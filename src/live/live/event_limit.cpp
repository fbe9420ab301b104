// SPDX-License-Identifier: Apache-2.0
#include "live/event_limit.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "live/tuning.hpp"

namespace kelpie::live {
namespace {

std::string kind_of(const std::string& event) {
  std::string kind = event.substr(0, event.find('\''));
  std::erase_if(kind, [](char letter) { return letter >= '0' && letter <= '9'; });
  return kind;
}

}  // namespace

bool EventLimit::passes(const std::string& event, Time now) {
  const std::string kind = kind_of(event);
  auto found = minutes_.find(kind);
  if (found == minutes_.end()) {
    // Beyond the most kinds, all others are one.
    const bool has_room = minutes_.size() < kTuning.most_event_kinds;
    found = minutes_.try_emplace(has_room ? kind : "", Minute{.began = now}).first;
  }
  Minute& minute = found->second;
  minute.last = event;
  return ++minute.events <= kTuning.most_events;
}

std::vector<std::string> EventLimit::left_out(Time now) {
  std::vector<std::string> texts;
  std::erase_if(minutes_, [&](const auto& one) {
    const Minute& minute = one.second;
    const bool has_ended = now - minute.began >= std::chrono::minutes(1);
    if (has_ended && minute.events > kTuning.most_events) {
      texts.push_back(fmt::format("{} more events in a minute, the last: {}",
                                  minute.events - kTuning.most_events, minute.last));
    }
    return has_ended;
  });
  return texts;
}

}  // namespace kelpie::live
