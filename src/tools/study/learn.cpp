// SPDX-License-Identifier: Apache-2.0
#include "study/learn.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/text.hpp"
#include "kelpie/motion/attitude.hpp"
#include "kelpie/motion/term_set.hpp"
#include "study/alignment.hpp"
#include "study/baselines.hpp"
#include "study/current.hpp"
#include "study/diagnosis.hpp"
#include "study/training_scales.hpp"

namespace kelpie::study {

std::string LearnPlan::scales_text() const {
  if (!from.empty()) {
    return "as in " + from;
  }
  if (settings.shared.learner == LearnerKind::posterior) {
    return "of the samples so far";
  }
  if (scales == "first") {
    return "first " + std::to_string(settings.shared.warmup) + " training samples";
  }
  return scales == "train" ? "all training rows (known beforehand)" : scales;
}

namespace {

// Angles beyond those in radians are in degrees; beyond those, too, they are commands.
void settle_angles(const log::Dataset& data, const Split& split, std::string& terms) {
  if (trimmed(terms) != TermSet::kAuto) {
    return;
  }
  std::vector<double> largest(data.input_names.size());
  for (const std::size_t row : split.training) {
    const std::span<const double> x = data.input(row);
    std::ranges::transform(x, largest, largest.begin(), [](double value, double most) {
      return std::max(std::abs(value), most);
    });
  }
  const AngleUnit unit = unit_of_angles(find_attitude(data.input_names), largest);
  if (unit != AngleUnit::radians) {
    terms = unit == AngleUnit::degrees ? TermSet::kAutoDegrees : "quadratic";
  }
}

}  // namespace

LearnPlan plan_learning(log::Dataset data, const SplitSettings& split, ModelSettings settings,
                        const std::string& align, const std::optional<AlignmentResult>& known,
                        bool with_lags, const std::string& current) {
  LearnPlan plan{.data = std::move(data),
                 .split = {},
                 .settings = std::move(settings),
                 .alignment = {},
                 .seed = split.seed};
  plan.split = make_split(plan.data, split);
  if (!known) {
    settle_angles(plan.data, plan.split, plan.settings.shared.terms);
  }
  plan.alignment =
      known ? *known : choose_alignment(plan.data, plan.split, plan.settings.shared.states, align);
  plan.alignment.alignment.water = {};
  if (current != "none") {
    plan.current = choose_current(plan.data, plan.split, plan.settings.shared.states,
                                  plan.alignment.alignment);
  }
  if (!plan.current.current.none()) {
    plan.data = through_water(std::move(plan.data), plan.current.current);
    if (!known) {
      plan.alignment = choose_alignment(plan.data, plan.split, plan.settings.shared.states, align);
    }
  }
  plan.commands = plan.alignment.alignment.commands;
  if (plan.commands.empty()) {
    plan.commands = commands_of(plan.data, plan.split, plan.settings.shared.states);
  }
  if (with_lags) {
    plan.lags = lags_of(plan.data, plan.split, plan.alignment.alignment);
  }
  plan.data = aligned(std::move(plan.data), plan.alignment.alignment);
  plan.alignment.alignment.water = plan.current.current;
  return plan;
}

DynamicsModel make_model(const LearnPlan& plan) {
  // Fails early where the scaling could never be found on line.
  const std::vector<AxisScaling> training =
      training_scales(plan.data, plan.split.training, plan.settings.shared);
  if (plan.scales == "first") {
    return {plan.data.input_names, plan.data.target_names, plan.settings};
  }
  return {plan.data.input_names, plan.data.target_names, plan.settings,
          plan.scales == "train" ? training : plan.given_scales};
}

StreamResult learn(const LearnPlan& plan, DynamicsModel& model, const StreamOptions& options) {
  StreamResult result = run_stream(plan.data, plan.split, model, options);
  add_baselines(plan.data, plan.split, plan.commands, result);
  describe(plan, result);
  result.memory_bytes = DynamicsModel::bytes(plan.data.input_names, plan.settings);
  result.diagnosis = diagnosis_of(model);
  return result;
}

void describe(const LearnPlan& plan, StreamResult& result) {
  result.from = plan.from;
  result.nominal = plan.nominal;
  result.scales = plan.scales_text();
  result.seed = plan.seed;
  result.commands = plan.commands;
  result.alignment = plan.alignment;
  result.current = plan.current;
  result.settings = plan.settings.values();
}

}  // namespace kelpie::study
