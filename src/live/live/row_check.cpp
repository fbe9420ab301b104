// SPDX-License-Identifier: Apache-2.0
#include "live/row_check.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "live/tuning.hpp"

namespace kelpie::live {

namespace {

bool derives_all_targets(const StreamPlan& plan) {
  const std::vector<std::string> of_pose =
      plan.pose ? plan.pose->accelerations() : std::vector<std::string>{};
  return std::ranges::all_of(plan.targets, [&](const std::string& target) {
    return std::ranges::count(of_pose, target) > 0 ||
           std::ranges::count(plan.derived, target, &StreamPlan::Derived::name) > 0;
  });
}

}  // namespace

RowCheck::RowCheck(const StreamPlan& plan, std::string states)
    : states_(std::move(states)),
      is_idle_(derives_all_targets(plan)),
      thinning_(static_cast<std::size_t>(
          std::max(1.0, std::ceil(plan.rate_hz / kTuning.checked_rate_hz)))) {
  rows_.input_names = plan.inputs;
  rows_.target_names = plan.targets;
  std::ranges::transform(plan.derived, std::back_inserter(rows_.derived),
                         &StreamPlan::Derived::name);
  rows_.rate_hz = plan.rate_hz / static_cast<double>(thinning_);
  due_ = std::max(static_cast<std::size_t>(kTuning.checked_s * rows_.rate_hz),
                  kTuning.least_checked_rows);
}

std::vector<log::Mistake> RowCheck::take(const Row& row) {
  if (is_idle_ || passed_++ % thinning_ != 0) {
    return {};
  }
  rows_.inputs.insert(rows_.inputs.end(), row.x.begin(), row.x.end());
  rows_.targets.insert(rows_.targets.end(), row.y.begin(), row.y.end());
  rows_.times_s.push_back(row.t);
  rows_.configurations.push_back(0);
  return rows_.rows() < due_ ? std::vector<log::Mistake>{} : finish();
}

std::vector<log::Mistake> RowCheck::finish() {
  std::vector<log::Mistake> found = log::target_mistakes(rows_, states_);
  rows_.inputs.clear();
  rows_.targets.clear();
  rows_.times_s.clear();
  rows_.configurations.clear();
  return found;
}

}  // namespace kelpie::live
