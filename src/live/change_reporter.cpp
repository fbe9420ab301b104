// SPDX-License-Identifier: Apache-2.0
#include "live/change_reporter.hpp"

#include <fmt/format.h>

#include "kelpie/motion/wording.hpp"

namespace kelpie::live {

void ChangeReporter::report(const DynamicsModel& model, std::size_t learned, double t,
                            Output& output) {
  if (!was_ready_ && model.ready()) {
    was_ready_ = true;
    output.event(fmt::format("at {:.1f} s: a model is in service, after {} samples", t, learned));
  }
  report_vehicle(model, t, output);
  for (std::size_t i = 0; i < model.axes(); ++i) {
    const Decision& decision = model.decisions()[i];
    const std::string& axis = plan_->targets[i];
    if (decision.changed) {
      output.event(fmt::format(
          "at {:.1f} s: {}: the vehicle has changed{}", t, axis,
          decision.recalled > 0 ? fmt::format("; past model {} fits", decision.recalled) : ""));
    }
    if (decision.withdrawn) {
      output.event(fmt::format("at {:.1f} s: {}: the last change was none", t, axis));
    }
  }
}

// Once it has a name, or won't get one; when that becomes another; and when it is final.
void ChangeReporter::report_vehicle(const DynamicsModel& model, double t, Output& output) {
  const Diagnosis* const diagnosis = model.diagnosis();
  if (diagnosis == nullptr || diagnosis->findings().empty()) {
    return;
  }
  const Finding& last = diagnosis->findings().back();
  const bool is_news = last.told_s > told_s_ || (last.settled && !settled_);
  if (last.state == FindingState::looking || !is_news) {
    return;
  }
  vehicle_ = finding_text(last, {plan_->inputs, plan_->targets});
  told_s_ = last.told_s;
  settled_ = last.settled;
  output.event(fmt::format("at {:.1f} s: {}{}", t, vehicle_, settled_ ? " (final)" : ""));
}

}  // namespace kelpie::live
