// SPDX-License-Identifier: Apache-2.0
#include "autopilot/parameter_keeper.hpp"

#include <algorithm>

#include "autopilot/tuning.hpp"
#include "core/text.hpp"

namespace kelpie::autopilot {

std::vector<std::string> ParameterKeeper::missing() const {
  std::vector<std::string> names;
  for (const std::size_t output : outputs_) {
    if (const std::string name = log::next_parameter(known_, output); !name.empty()) {
      names.push_back(name);
    }
  }
  if (!outputs_.empty() && !known_.contains("FRAME_CONFIG")) {
    names.emplace_back("FRAME_CONFIG");
  }
  return names;
}

std::optional<std::string> ParameterKeeper::next_request(Time now) {
  const bool waits = !waiting_.empty() && !known_.contains(waiting_);
  if (waits && last_ && now - *last_ < kTuning.between_parameters) {
    return std::nullopt;
  }
  waiting_.clear();
  std::vector<std::string> names = missing();
  std::erase_if(names, [&](const std::string& name) {
    const auto asked = asked_.find(name);
    return asked != asked_.end() && asked->second >= kTuning.most_asked;
  });
  if (names.empty()) {
    return std::nullopt;
  }
  const auto times = [&](const std::string& name) {
    const auto asked = asked_.find(name);
    return asked == asked_.end() ? 0 : asked->second;
  };
  waiting_ = *std::ranges::min_element(names, {}, times);
  ++asked_[waiting_];
  last_ = now;
  return waiting_;
}

std::vector<std::string> ParameterKeeper::faults() const {
  std::vector<std::string> silent;
  for (const std::string& name : missing()) {
    const auto asked = asked_.find(name);
    if (asked != asked_.end() && asked->second >= kTuning.most_asked) {
      silent.push_back(name);
    }
  }
  if (silent.empty()) {
    return {};
  }
  return {"the vehicle does not tell its parameters " + join_text(silent, ", ")};
}

}  // namespace kelpie::autopilot
