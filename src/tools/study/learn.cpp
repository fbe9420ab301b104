// SPDX-License-Identifier: Apache-2.0
#include "study/learn.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/text.hpp"
#include "kelpie/motion/attitude.hpp"
#include "kelpie/motion/term_set.hpp"
#include "log/row_clock.hpp"
#include "motion/states.hpp"
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

using Columns = std::vector<std::vector<double>>;

Columns column_lists(const log::Dataset& data, bool is_input) {
  const std::size_t width = is_input ? data.input_names.size() : data.target_names.size();
  Columns columns(width);
  for (std::size_t row = 0; row < data.rows(); ++row) {
    for (std::size_t k = 0; k < width; ++k) {
      columns[k].push_back((is_input ? data.input(row) : data.target(row))[k]);
    }
  }
  return columns;
}

// Whether an input is a velocity by its name, or by what is known of the commands.
bool is_velocity(const LearnPlan& plan, std::size_t input) {
  const std::string& name = plan.data.input_names[input];
  return velocity_axis(name).has_value() ||
         (!plan.commands.empty() && std::ranges::count(plan.commands, name) == 0 &&
          !find_attitude(plan.data.input_names).contains(input));
}

// What R² on the held-out rows is worth.
void judge_split(const LearnPlan& plan, StreamResult& result) {
  const log::Dataset& data = plan.data;
  const Columns inputs = column_lists(data, true);
  const Columns targets = column_lists(data, false);
  std::vector<log::KnownColumn> motion;
  double memory_rows = std::numeric_limits<double>::infinity();
  for (std::size_t target = 0; target < targets.size(); ++target) {
    motion.push_back({data.target_names[target], targets[target], true});
  }
  for (std::size_t input = 0; input < inputs.size(); ++input) {
    if (is_velocity(plan, input)) {
      motion.push_back({data.input_names[input], inputs[input], false});
      memory_rows = std::min(memory_rows, log::memory_rows(inputs[input]));
    }
  }
  for (std::size_t input = 0; input < inputs.size(); ++input) {
    const std::string& name = data.input_names[input];
    const std::string copied =
        is_velocity(plan, input) ? "" : log::near_copy_of({name, inputs[input], false}, motion);
    if (!copied.empty()) {
      result.answers.push_back(name + " " + copied);
    }
  }
  if (!std::isfinite(memory_rows) || plan.split.held_out.empty()) {
    return;
  }
  result.memory_s = memory_rows / data.rate_hz;
  result.judging_memories = 0.0;
  std::size_t stretch = 0;
  for (std::size_t i = 0; i < plan.split.held_out.size(); ++i) {
    ++stretch;
    const bool goes_on = i + 1 < plan.split.held_out.size() &&
                         log::follows(data, plan.split.held_out[i], plan.split.held_out[i + 1]);
    if (!goes_on) {
      result.judging_memories += std::floor(static_cast<double>(stretch) / memory_rows);
      stretch = 0;
    }
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
  judge_split(plan, result);
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
