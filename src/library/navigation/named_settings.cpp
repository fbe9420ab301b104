// SPDX-License-Identifier: Apache-2.0
#include "navigation/named_settings.hpp"

#include <algorithm>
#include <array>
#include <optional>

namespace kelpie {
namespace {

constexpr std::size_t kRollRate = 3;                   // the first angular velocity
constexpr std::array<std::size_t, 3> kPlane{0, 1, 5};  // surge, sway, yaw rate

std::optional<std::size_t> axis_of(const OpenLoop& model, std::size_t velocity) {
  return velocity < model.axes.size() ? model.axes[velocity] : std::nullopt;
}

}  // namespace

DeadReckoningSettings named_settings(const OpenLoop& model) {
  DeadReckoningSettings settings;
  settings.planar = std::ranges::equal(
      std::span(model.axes).first(std::min(kPlane.size(), model.axes.size())), kPlane);
  for (std::size_t i = 0; i < model.states.size(); ++i) {
    if (axis_of(model, i) >= kRollRate) {
      settings.rates.push_back(i);
    }
  }
  if (settings.rates.size() == model.states.size()) {
    settings.rates.clear();  // the log measures something
  }
  return settings;
}

bool may_be_planar(const OpenLoop& model) {
  for (std::size_t i = 0; i < kPlane.size(); ++i) {
    if (i >= model.states.size() || axis_of(model, i).value_or(kPlane[i]) != kPlane[i]) {
      return false;
    }
  }
  return true;
}

}  // namespace kelpie
