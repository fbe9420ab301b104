// SPDX-License-Identifier: Apache-2.0
#include "live/authority_reporter.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <utility>

#include "kelpie/core/error.hpp"
#include "live/tuning.hpp"

namespace kelpie::live {

AuthorityReporter::AuthorityReporter(const StreamPlan& plan)
    : plan_(&plan),
      least_(plan.inputs.size()),
      most_(plan.inputs.size()),
      told_(plan.targets.size(), 1.0) {}

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
  const std::string text = authority.text({plan_->inputs, plan_->targets});
  bool is_news = authority.lost_axis() != std::exchange(lost_told_, authority.lost_axis()) &&
                 authority.lost_axis() < authority.axes().size();
  bool is_less = false;
  for (std::size_t i = 0; i < authority.axes().size(); ++i) {
    const double left = authority.axes()[i].left();
    is_news = is_news || std::abs(left - told_[i]) >= kTuning.authority_news;
    is_less = is_less || std::abs(left - 1.0) >= kTuning.authority_news;
    if (i < health.axes.size()) {
      health.axes[i].authority = left;
    }
  }
  health.authority = is_less || authority.lost_axis() < authority.axes().size() ? text : "";
  health.held_current = authority.held_current();
  health.effectiveness = std::move(known);
  if (is_news) {
    for (std::size_t i = 0; i < told_.size(); ++i) {
      told_[i] = authority.axes()[i].left();
    }
    output.event(fmt::format("at {:.1f} s: {}", t, text));
  }
}

}  // namespace kelpie::live
