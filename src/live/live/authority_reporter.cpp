// SPDX-License-Identifier: Apache-2.0
#include "live/authority_reporter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kelpie/core/error.hpp"
#include "live/tuning.hpp"

namespace kelpie::live {

AuthorityReporter::AuthorityReporter(const Configuration& configuration)
    : plan_(&configuration.plan),
      units_(configuration.units()),
      least_(plan_->inputs.size()),
      most_(plan_->inputs.size()),
      told_(plan_->targets.size(), 1.0) {}

void AuthorityReporter::observe(std::span<const double> x) {
  for (std::size_t i = 0; i < x.size(); ++i) {
    least_[i] = std::fmin(least_[i], x[i]);
    most_[i] = std::fmax(most_[i], x[i]);
  }
}

// A thruster that was never commanded has no range.
std::vector<CommandRange> AuthorityReporter::ranges(const Diagnosis& diagnosis) const {
  std::vector<CommandRange> ranges;
  for (const Cause& thruster : diagnosis.present()) {
    const std::size_t i = thruster.place;
    if (least_[i] < most_[i]) {
      ranges.push_back({.input = i, .least = least_[i], .most = most_[i]});
    }
  }
  return ranges;
}

// Of surge; empty where the log does not tell.
std::string_view AuthorityReporter::speed_unit(const Diagnosis& diagnosis) const {
  const auto surge = std::ranges::find(diagnosis.body_axes(), std::size_t{0});
  if (surge == diagnosis.body_axes().end()) {
    return "";
  }
  const auto axis = static_cast<std::size_t>(surge - diagnosis.body_axes().begin());
  const auto unit = units_.find(plan_->inputs[diagnosis.states()[axis]]);
  return unit != units_.end() && unit->second == Unit::parse("m/s") ? "m/s" : "";
}

void AuthorityReporter::update(const Diagnosis* diagnosis, const Alignment& alignment, double t,
                               LearnerHealth& health, Output& output) {
  health.authority.clear();
  health.effectiveness.reset();
  health.held_current = std::numeric_limits<double>::quiet_NaN();
  if (diagnosis == nullptr || !diagnosis->knows_thrust() || ranges(*diagnosis).empty()) {
    return;
  }
  auto known = std::make_shared<const Effectiveness>(
      Effectiveness{Authority(*diagnosis, ranges(*diagnosis)), alignment});
  const Authority& authority = known->authority;
  const std::string text = authority.text({plan_->inputs, plan_->targets}, speed_unit(*diagnosis));
  const bool is_lost = authority.lost_axis() < authority.axes().size();
  bool is_news =
      authority.lost_axis() != std::exchange(lost_told_, authority.lost_axis()) && is_lost;
  bool is_less = false;
  for (std::size_t i = 0; i < authority.axes().size(); ++i) {
    const double left = authority.axes()[i].left();
    is_news = is_news || std::abs(left - told_[i]) >= kTuning.authority_news;
    is_less = is_less || std::abs(left - 1.0) >= kTuning.authority_news;
    if (i < health.axes.size()) {
      health.axes[i].authority = left;
    }
  }
  health.authority = is_less || is_lost ? text : "";
  health.held_current = authority.held_current();
  health.effectiveness = std::move(known);
  if (is_news) {
    for (std::size_t i = 0; i < told_.size(); ++i) {
      told_[i] = authority.axes()[i].left();
    }
    output.event(fmt::format("at {:.1f} s: {}{}", t, is_lost ? kWarning : "", text));
  }
}

}  // namespace kelpie::live
