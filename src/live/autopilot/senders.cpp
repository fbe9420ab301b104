// SPDX-License-Identifier: Apache-2.0
#include "autopilot/senders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <tuple>

#include "autopilot/tuning.hpp"

namespace kelpie::autopilot {

bool Senders::accept(const mavlink::Frame& frame, const Address& from, bool has_data, Time now) {
  const Id id{frame.system, frame.component};
  Sender* sender = find(id);
  if (sender == nullptr) {
    sender = place(id);
    if (sender == nullptr) {
      ++refused_;
      return false;
    }
    *sender = {.id = id, .from = from};
  } else if (sender->from != from) {
    if (now - sender->heard <= kTuning.longest_silence) {
      sender->rival = sender->rival.value_or(from);
      sender->rival_heard = now;
      ++refused_;
      return false;
    }
    sender->from = from;
    sender->rival.reset();
  }
  sender->heard = now;
  sender->is_autopilot |= bag::is_of_autopilot(frame);
  sender->has_data |= has_data;
  if (!vehicle_ && may_be_vehicle(id) && sender->is_autopilot && sender->has_data) {
    vehicle_ = id;
  } else if (vehicle_ && vehicle_ != id && sender->is_autopilot && stated_.system == 0) {
    others_heard_ = now;
  }
  return true;
}

bool Senders::may_be_vehicle(const Id& id) const {
  return (stated_.system == 0 || stated_.system == id.system) &&
         (stated_.component == 0 || stated_.component == id.component);
}

bool Senders::is_kept(const Id& id) const {
  return id == vehicle_ || std::ranges::count(named_, id) > 0 ||
         (stated_.system != 0 && may_be_vehicle(id));
}

Senders::Sender* Senders::find(const Id& id) {
  const auto found = std::ranges::find(senders_, id, &Sender::id);
  return found == senders_.end() ? nullptr : &*found;
}

// For a new sender; null: the table is full of others that stay.
Senders::Sender* Senders::place(const Id& id) {
  if (senders_.size() < kTuning.most_senders || is_kept(id)) {
    return &senders_.emplace_back();
  }
  const auto rank = [&](const Sender& one) {
    return std::tuple(is_kept(one.id), one.has_data, one.heard);
  };
  const auto least = std::ranges::min_element(senders_, {}, rank);
  return is_kept(least->id) ? nullptr : &*least;
}

const Senders::Sender* Senders::asked(Time now) {
  if (vehicle_) {
    asked_ = vehicle_;
  } else if (!asked_ || find(*asked_) == nullptr || now - asked_since_ > kTuning.longest_trial) {
    const auto may_be_asked = [&](const Sender& one) {
      return one.is_autopilot && may_be_vehicle(one.id);
    };
    const auto last =
        std::ranges::find_if(senders_, [&](const Sender& one) { return one.id == asked_; });
    const auto begin = last == senders_.end() ? last : std::next(last);
    auto next = std::find_if(begin, senders_.end(), may_be_asked);
    next = next == senders_.end() ? std::ranges::find_if(senders_, may_be_asked) : next;
    asked_ = next == senders_.end() ? std::nullopt : std::optional(next->id);
    asked_since_ = now;
  }
  return asked_ ? find(*asked_) : nullptr;
}

std::vector<std::string> Senders::faults(Time now) const {
  std::vector<std::string> faults;
  for (const Sender& sender : senders_) {
    const bool matters = sender.id == vehicle_ || sender.id == asked_ || is_kept(sender.id);
    if (matters && sender.rival && now - sender.rival_heard <= kTuning.fault_memory) {
      faults.push_back(fmt::format(
          "two senders are system {}, component {}: {} is heard, {} is refused", sender.id.system,
          sender.id.component, sender.from.text(), sender.rival->text()));
    }
  }
  if (others_heard_ != Time{} && now - others_heard_ <= kTuning.fault_memory) {
    faults.emplace_back(
        "several autopilots are heard; system and component in [live.mavlink] state the vehicle");
  }
  return faults;
}

}  // namespace kelpie::autopilot
