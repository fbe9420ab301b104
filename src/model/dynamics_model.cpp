// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/dynamics_model.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <numeric>
#include <optional>
#include <utility>

#include "kelpie/core/text.hpp"
#include "kelpie/model/axis_gradient.hpp"
#include "kelpie/motion/states.hpp"
#include "model/answer.hpp"

namespace kelpie {
namespace {

std::vector<std::size_t> body_axes(std::span<const std::string> inputs,
                                   std::span<const std::size_t> states) {
  std::vector<std::size_t> axes;
  std::ranges::transform(states, std::back_inserter(axes), [&](std::size_t state) {
    return velocity_axis(inputs[state]).value_or(Diagnosis::kUnknownAxis);
  });
  return axes;
}

std::size_t most_places(const ModelSettings& settings) {
  std::size_t most = 0;
  for (const OnlineSvrSettings& axis : settings.axes) {
    most = std::max(most, axis.places());
  }
  return most;
}

constexpr const char* kStateVersion = "9";  // of what visit() says, all classes together

}  // namespace

DynamicsModel::DynamicsModel(std::vector<std::string> inputs, std::vector<std::string> targets,
                             ModelSettings settings, const AxisScaling* scaling)
    : OnlineModel(targets.size()),
      input_names_(std::move(inputs)),
      target_names_(std::move(targets)),
      settings_(std::move(settings)) {
  const std::size_t dimension = input_names_.size();
  require(dimension >= 1 && dimension <= kMostInputs, "inputs",
          std::to_string(dimension) + " given; a model takes 1 to " + std::to_string(kMostInputs));
  require(!target_names_.empty(), "targets", "none given; a model needs one or more");
  require(settings_.axes.size() == target_names_.size(), "settings",
          "for " + std::to_string(settings_.axes.size()) + " axes; there are " +
              std::to_string(target_names_.size()) + " targets");
  settings_.validate();
  work_ = WorkLimit(settings_.axes.size(), most_places(settings_));
  const TermSet terms = TermSet::from(settings_.shared.terms, input_names_, target_names_.size());
  const std::vector<std::size_t> states =
      find_states(settings_.shared.states, input_names_, target_names_.size());
  const TermSet steady = TermSet::open_loop(input_names_, states);
  if (!states.empty() && Diagnosis::terms(dimension, states) <= kMostTerms) {
    diagnosis_.emplace(dimension, states, body_axes(input_names_, states));
  }
  axes_.reserve(settings_.axes.size());
  for (std::size_t i = 0; i < settings_.axes.size(); ++i) {
    std::optional<SteadyPart> part;
    if (!states.empty() && steady.size() > 0) {
      part.emplace(steady, dimension, states[i]);
    }
    std::optional<AxisScaling> given;
    if (scaling != nullptr) {
      given = scaling[i];
      require(given->term_scale.size() == terms.size(), "scaling",
              "of " + std::to_string(given->term_scale.size()) + " terms; there are " +
                  std::to_string(terms.size()));
    }
    axes_.emplace_back(dimension, settings_.shared, settings_.axes[i], terms, std::move(given),
                       std::move(part));
  }
}

DynamicsModel::DynamicsModel(std::vector<std::string> inputs, std::vector<std::string> targets,
                             const ModelSettings& settings)
    : DynamicsModel(std::move(inputs), std::move(targets), settings, nullptr) {}

DynamicsModel::DynamicsModel(std::vector<std::string> inputs, std::vector<std::string> targets,
                             const ModelSettings& settings, std::span<const AxisScaling> scaling)
    : DynamicsModel(
          std::move(inputs), std::move(targets), settings,
          (require(scaling.size() == settings.axes.size(), "scaling", "one per target is needed"),
           scaling.data())) {}

std::size_t DynamicsModel::bytes(std::span<const std::string> inputs,
                                 const ModelSettings& settings) {
  const TermSet terms = TermSet::from(settings.shared.terms, inputs, settings.axes.size());
  const Committee::Plan plan = DynamicsAxis::committee_plan(settings.shared, terms);
  return std::transform_reduce(settings.axes.begin(), settings.axes.end(), std::size_t{0},
                               std::plus<>{}, [&](const OnlineSvrSettings& axis) {
                                 return Committee::bytes(inputs.size(), terms.size(), axis, plan) +
                                        2 * sizeof(ConformalInterval) + sizeof(Disturbance);
                               });
}

void DynamicsModel::predict(std::span<const double> x, std::span<double> y) const {
  const AccessGuard::Reader reading(access());
  answer(x, inputs(), y, axes(), [&](std::size_t i) { return axes_[i].predict(x); });
}

void DynamicsModel::predict_with_jacobian(std::span<const double> x, std::span<double> y,
                                          std::span<double> jacobian) const {
  const AccessGuard::Reader reading(access());
  answer(x, inputs(), y, axes(), jacobian, [&](std::size_t i, std::span<double> gradient) {
    const DynamicsAxis& axis = axes_[i];
    if (axis.scaling() != nullptr && axis.status().ready) {
      return predict_with_gradient(*axis.scaling(), axis.terms(), axis.committee(), x, gradient);
    }
    std::ranges::fill(gradient, 0.0);
    return axis.predict(x);
  });
}

void DynamicsModel::predict(std::span<const double> x, std::span<Prediction> y,
                            double ahead_s) const {
  const AccessGuard::Reader reading(access());
  answer(x, inputs(), y, axes(), [&](std::size_t i) { return axes_[i].assess(x, ahead_s); });
}

void DynamicsModel::learned(std::span<const double> x, std::span<const double> y, double t) {
  work_.learned(std::ranges::any_of(decisions(), [](const Decision& decision) {
    return decision.verdict == Verdict::crowded_out;
  }));
  // No grant survives its update: the model may be moved.
  std::ranges::for_each(axes_, [&](DynamicsAxis& axis) { axis.limit(budget_); });
  if (diagnosis_) {
    diagnosis_->update(x, y, t);
  }
}

std::vector<Finding> DynamicsModel::findings() const {
  std::vector<Finding> findings;
  if (diagnosis_) {
    findings = diagnosis_->findings();
  }
  for (Finding& finding : findings) {
    for (double* const time : {&finding.since_s, &finding.found_s, &finding.told_s}) {
      *time = clock().stamp(*time);
    }
  }
  return findings;
}

bool DynamicsModel::ready() const {
  return std::ranges::all_of(axes_, [](const auto& axis) { return axis.status().ready; });
}

std::string DynamicsModel::save() const {
  const AccessGuard::Reader reading(access());
  Archive archive;
  const_cast<DynamicsModel*>(this)->visit(archive);  // NOLINT: an archive that saves only reads
  return archive.bytes();
}

DynamicsModel DynamicsModel::resume(DynamicsModel fresh, std::string_view saved) {
  Archive archive(saved);
  fresh.visit(archive);
  archive.finish();
  return fresh;
}

DynamicsModel DynamicsModel::resume_from(const TrainedModel& trained, double start_s) {
  DynamicsModel model(trained.input_names, trained.target_names(), trained.settings);
  const std::size_t terms = model.axes_.front().terms().size();
  for (std::size_t i = 0; i < trained.axes.size(); ++i) {
    const TrainedModel::Axis& axis = trained.axes[i];
    require(axis.scaling.term_scale.size() == terms, "terms",
            "give " + std::to_string(terms) + " physics terms; the trained model has " +
                std::to_string(axis.scaling.term_scale.size()));
    model.axes_[i].resume_from(axis.scaling, axis.function, start_s);
  }
  return model;
}

void DynamicsModel::visit(Archive& archive) {
  archive.same("version", kStateVersion);
  archive.same("inputs", join_text(input_names_, ", "));
  archive.same("targets", join_text(target_names_, ", "));
  for (const auto& [name, value] : settings_.values()) {
    archive.same(name, value);
  }
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    archive.part(target_names_[i], axes_[i]);
  }
  archive.part("clock", clock());
  archive.part("work", work_);
  if (diagnosis_) {
    archive.part("diagnosis", *diagnosis_);
  }
}

TrainedModel DynamicsModel::trained() const {
  const AccessGuard::Reader reading(access());
  TrainedModel model{input_names_, settings_, axes_.front().terms(), {}};
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    // NOLINTNEXTLINE(bugprone-unchecked-optional-access): what is ready has its scaling
    model.axes.push_back({target_names_[i], *axes_[i].scaling(),
                          axes_[i].committee().function_mix(), axes_[i].status().kkt_gap,
                          axes_[i].steady(), axes_[i].half_width(),
                          axes_[i].svr().champion().buffer().known_places()});
  }
  return model;
}

}  // namespace kelpie
