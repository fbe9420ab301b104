// SPDX-License-Identifier: Apache-2.0
#include "autopilot/rate_keeper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "autopilot/tuning.hpp"

namespace kelpie::autopilot {
namespace {

std::string result_text(int result) {
  constexpr std::array<const char*, 10> kResults{
      "accepted",    "not now",   "denied",    "unsupported", "failed",
      "in progress", "cancelled", "long only", "int only",    "unsupported frame"};
  return result >= 0 && result < static_cast<int>(kResults.size())
             ? kResults[static_cast<std::size_t>(result)]
             : fmt::format("result {}", result);
}

}  // namespace

RateKeeper::RateKeeper(const std::vector<MessageRate>& wanted) {
  std::ranges::transform(wanted, std::back_inserter(states_),
                         [](const MessageRate& one) { return State{.wanted = one}; });
}

void RateKeeper::count_message(std::uint32_t id, Time now) {
  measured_ = measured_.value_or(now);
  for (State& state : states_) {
    state.count += state.wanted.id == id ? 1 : 0;
  }
}

void RateKeeper::acknowledge(int result, Time /*now*/) {
  if (!requested_ || result == kInProgress) {
    return;
  }
  State& state = states_[*requested_];
  state.refused = result == kAccepted ? std::nullopt : std::optional(result);
  requested_.reset();
}

std::optional<RateKeeper::MessageRate> RateKeeper::next_request(Time now) {
  measure(now);
  const std::optional<Time> asked = requested_ ? states_[*requested_].asked : std::nullopt;
  if (asked && now - *asked < kTuning.longest_answer) {
    return std::nullopt;
  }
  requested_.reset();
  const auto is_due = [&](const State& state) {
    return !state.asked || (!state.slow.empty() && now - *state.asked >= kTuning.between_requests);
  };
  const auto due = std::ranges::find_if(states_, is_due);
  if (due == states_.end()) {
    return std::nullopt;
  }
  due->asked = now;
  requested_ = static_cast<std::size_t>(due - states_.begin());
  return due->wanted;
}

void RateKeeper::measure(Time now) {
  if (!measured_ || now - *measured_ < kTuning.between_measurements) {
    return;
  }
  const double passed_s = std::chrono::duration<double>(now - *measured_).count();
  for (State& state : states_) {
    const double rate_hz = static_cast<double>(state.count) / passed_s;
    state.count = 0;
    // A message requested just now has yet to begin.
    const bool has_had_time = state.asked && now - *state.asked > kTuning.between_measurements;
    if (rate_hz >= kTuning.enough * state.wanted.rate_hz) {
      state.slow.clear();
    } else if (has_had_time && state.slow.empty()) {
      state.slow = rate_hz > 0.0 ? fmt::format("{} comes at {:.1f} Hz; {:g} Hz are asked for",
                                               state.wanted.name, rate_hz, state.wanted.rate_hz)
                                 : fmt::format("{} doesn't come; {:g} Hz are asked for",
                                               state.wanted.name, state.wanted.rate_hz);
    }
  }
  measured_ = now;
}

std::vector<std::string> RateKeeper::faults() const {
  std::vector<std::string> faults;
  for (const State& state : states_) {
    if (state.slow.empty()) {
      continue;
    }
    faults.push_back(state.slow);
    if (state.refused) {
      faults.push_back(fmt::format("{}: the vehicle refuses to send it at {:g} Hz ({})",
                                   state.wanted.name, state.wanted.rate_hz,
                                   result_text(*state.refused)));
    }
  }
  return faults;
}

}  // namespace kelpie::autopilot
