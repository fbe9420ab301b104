// SPDX-License-Identifier: Apache-2.0
#include "live/change_reporter.hpp"

#include <fmt/format.h>

#include "kelpie/vehicle/diagnosis.hpp"
#include "live/health_table.hpp"

namespace kelpie::live {
namespace {

// One event, one wording: an axis finds the change, the diagnosis adds its cause later.
std::string change_text(const std::string& what) {
  return fmt::format("{}: {}", kVehicleChanged, what);
}

}  // namespace

void ChangeReporter::report(const DynamicsModel& model, std::size_t learned, double t,
                            Output& output) {
  const auto event = [&](const std::string& text) {
    output.event(fmt::format("at {:.1f} s: {}", t, text));
  };
  if (!was_ready_ && model.ready()) {
    was_ready_ = true;
    event(fmt::format("a model is in service, after {} samples", learned));
  }
  if (update_vehicle(model)) {
    event(vehicle_ + (settled_ ? " (final)" : ""));
  }
  for (std::size_t i = 0; i < model.axes(); ++i) {
    const Decision& decision = model.decisions()[i];
    const std::string& axis = plan_->targets[i];
    if (decision.changed) {
      event(change_text(decision.recalled > 0
                            ? fmt::format("{}; past model {} fits", axis, decision.recalled)
                            : axis));
    }
    if (decision.withdrawn) {
      event(fmt::format("{}: the last change was withdrawn", axis));
    }
  }
}

// News: the finding has a name, or will not get one; another name; the final one.
bool ChangeReporter::update_vehicle(const DynamicsModel& model) {
  const Diagnosis* const diagnosis = model.diagnosis();
  if (diagnosis == nullptr || diagnosis->findings().empty()) {
    return false;
  }
  const Finding& last = diagnosis->findings().back();
  const bool is_news = last.told_s > told_s_ || (last.settled && !settled_);
  if (last.state == FindingState::looking || !is_news) {
    return false;
  }
  const std::string text = finding_text(last, {plan_->inputs, plan_->targets});
  vehicle_ = last.state == FindingState::none ? text : change_text(text);
  told_s_ = last.told_s;
  settled_ = last.settled;
  return true;
}

}  // namespace kelpie::live
