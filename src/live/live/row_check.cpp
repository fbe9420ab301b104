// SPDX-License-Identifier: Apache-2.0
#include "live/row_check.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "live/tuning.hpp"

namespace kelpie::live {

RowCheck::RowCheck(const StreamPlan& plan, std::string states)
    : states_(std::move(states)),
      thinning_(static_cast<std::size_t>(
          std::max(1.0, std::ceil(plan.rate_hz / kTuning.checked_rate_hz)))) {
  rows_.input_names = plan.inputs;
  rows_.target_names = plan.targets;
  std::ranges::transform(plan.derived, std::back_inserter(rows_.derived),
                         &StreamPlan::Derived::name);
  if (plan.pose) {
    std::ranges::copy(plan.pose->accelerations(), std::back_inserter(rows_.derived));
  }
  rows_.rate_hz = plan.rate_hz / static_cast<double>(thinning_);
  due_ = std::max(static_cast<std::size_t>(kTuning.checked_s * rows_.rate_hz),
                  kTuning.least_checked_rows);
}

std::vector<log::Mistake> RowCheck::take(const Row& row) {
  if (passed_++ % thinning_ != 0) {
    return {};
  }
  rows_.inputs.insert(rows_.inputs.end(), row.x.begin(), row.x.end());
  rows_.targets.insert(rows_.targets.end(), row.y.begin(), row.y.end());
  rows_.times_s.push_back(row.t);
  rows_.configurations.push_back(0);
  return rows_.rows() < due_ ? std::vector<log::Mistake>{} : finish();
}

std::vector<log::Mistake> RowCheck::finish() {
  std::vector<log::Mistake> found = log::all_mistakes(rows_, states_);
  std::erase_if(found, [](const log::Mistake& one) { return !one.is_refused; });
  rows_.inputs.clear();
  rows_.targets.clear();
  rows_.times_s.clear();
  rows_.configurations.clear();
  return found;
}

}  // namespace kelpie::live
