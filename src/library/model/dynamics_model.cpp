// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/dynamics_model.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "core/roomy_vector.hpp"
#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/model/stored_past_model.hpp"
#include "kelpie/model/trained_model.hpp"
#include "kelpie/vehicle/diagnosis.hpp"
#include "model/answer.hpp"
#include "model/change_monitor.hpp"
#include "model/first_moves.hpp"
#include "model/model_axis.hpp"
#include "model/posterior_axis.hpp"
#include "model/snapshot.hpp"
#include "model/svr_axis.hpp"
#include "model/update_state.hpp"
#include "model/work_limit.hpp"
#include "motion/states.hpp"

namespace kelpie {
namespace {

constexpr const char* kStateVersion = "35";  // of the archive of all classes together

std::vector<std::size_t> body_axes(std::span<const std::string> inputs,
                                   std::span<const std::size_t> states) {
  std::vector<std::size_t> axes;
  std::ranges::transform(states, std::back_inserter(axes), [&](std::size_t state) {
    return velocity_axis(inputs[state]).value_or(Diagnosis::kUnknownAxis);
  });
  return axes;
}

// Inputs that are neither states nor of the attitude: the commands, or the other velocities.
std::vector<std::size_t> other_inputs(std::span<const std::string> inputs,
                                      std::span<const std::size_t> states, const Attitude& attitude,
                                      bool velocities) {
  std::vector<std::size_t> others;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (std::ranges::find(states, i) == states.end() && !attitude.contains(i) &&
        velocity_axis(inputs[i]).has_value() == velocities) {
      others.push_back(i);
    }
  }
  return others;
}

// Whether the diagnosis stands by the thrust of a command as a cause of the change since `since_s`:
// until the finding is taken back, or tells of other causes.
bool still_named(std::span<const Finding> findings, std::size_t command, double since_s) {
  if (findings.empty() || findings.back().since_s < since_s) {
    return false;
  }
  const Finding& last = findings.back();
  const auto is_thrust = [&](const Cause& cause) {
    return cause.kind == CauseKind::thruster && cause.place == command;
  };
  return last.since_s > since_s || last.state == FindingState::looking ||
         std::ranges::any_of(std::span(last.causes).first(last.count), is_thrust) ||
         (last.state == FindingState::ambiguous && is_thrust(last.rival));
}

// Whether the learner of every axis follows changes of the vehicle.
bool adapts(const ModelSettings& settings) {
  return settings.shared.learner != LearnerKind::svr &&
         std::ranges::all_of(settings.axes, [](const OnlineSvrSettings& axis) {
           return axis.adapt == AdaptRule::follow;
         });
}

std::size_t most_places(const ModelSettings& settings) {
  std::size_t most = 0;
  for (const OnlineSvrSettings& axis : settings.axes) {
    most = std::max(most, axis.places());
  }
  return most;
}

// In the order of the terms, the last of the term 1.
std::vector<double> coefficients_of(std::span<const Coefficient> known, const TermSet& terms) {
  std::vector<std::string> texts = terms.texts();
  texts.emplace_back("1");
  std::vector<double> values(texts.size(), 0.0);
  std::vector<bool> given(texts.size());
  for (const Coefficient& one : known) {
    const auto k = static_cast<std::size_t>(std::ranges::find(texts, one.term) - texts.begin());
    require(k < texts.size(), one.term,
            "not a term of this model, which has " + join_text(texts, ", "));
    require(!given[k], one.term, "given twice");
    require(std::isfinite(one.value), one.term, "has to be a finite coefficient");
    values[k] = one.value;
    given[k] = true;
  }
  return values;
}

// Messages, findings and files tell columns by their names. A target may be called as an input.
void require_distinct(std::string_view field, std::span<const std::string> names) {
  for (auto name = names.begin(); name != names.end(); ++name) {
    require(std::find(names.begin(), name, *name) == name, field, "name '" + *name + "' twice");
  }
}

void require_complete(std::span<const std::string> inputs, std::span<const std::string> targets,
                      const ModelSettings& settings) {
  require(
      !inputs.empty() && inputs.size() <= kMostInputs, "inputs",
      std::to_string(inputs.size()) + " given; a model takes 1 to " + std::to_string(kMostInputs));
  require(!targets.empty(), "targets", "none given; a model needs one or more");
  require(settings.axes.size() == targets.size(), "settings",
          "for " + std::to_string(settings.axes.size()) + " axes; there are " +
              std::to_string(targets.size()) + " targets");
  require_distinct("inputs", inputs);
  require_distinct("targets", targets);
  settings.validate();
}

bool is_refused(const Decision& decision) {
  return decision.verdict == Verdict::invalid || decision.verdict == Verdict::implausible;
}

bool is_settled(const Decision& decision) {
  return decision.had_model;
}

bool is_news(const Decision& decision) {
  return decision.changed || decision.withdrawn || decision.returning;
}

}  // namespace

struct DynamicsModel::Parts {
  Parts(std::vector<std::string> inputs, std::vector<std::string> targets,
        ModelSettings model_settings, const AxisScaling* scaling);

  void order_axes();
  bool trusts_sample() const;
  void begin_with_the_moves(std::span<const double> x, std::span<const double> y);
  void monitor_change(std::span<const double> x, std::span<const double> y, double t);
  void believe_diagnosis();
  void apply_change(ChangeMonitor::Event event);
  void update_diagnosis(std::span<const double> x, std::span<const double> y, double t);
  void observe_steady(std::span<const double> x, std::span<const double> y, double t);
  ModelAxis& axis_at(std::size_t axis) const;
  template <typename Holds>
  bool all_axes(Holds holds) const;
  void visit(Archive& archive);

  std::vector<std::string> input_names;
  std::vector<std::string> target_names;
  ModelSettings settings;
  UpdateState state;
  ModelAxes axes;
  RoomyVector<std::size_t> order;   ///< scratch: the axes in the order of the update at hand
  std::optional<FirstMoves> moves;  ///< for `change` and `diagnosis`
  std::optional<ChangeMonitor> change;
  std::optional<SteadyPart> steady;
  std::optional<Diagnosis> diagnosis;
  double named_since_s = -std::numeric_limits<double>::infinity();  ///< the last finding seen
  Budget budget;                                                    ///< of every update
  WorkLimit work{1, 1};
};

DynamicsModel::Parts::Parts(std::vector<std::string> inputs, std::vector<std::string> targets,
                            ModelSettings model_settings, const AxisScaling* scaling)
    : input_names(std::move(inputs)),
      target_names(std::move(targets)),
      settings(std::move(model_settings)),
      state(target_names.size()) {
  require_complete(input_names, target_names, settings);
  const std::size_t dimension = input_names.size();
  work = WorkLimit(settings.axes.size(), most_places(settings));
  const TermSet terms = TermSet::from(settings.shared.terms, input_names, target_names.size());
  const std::vector<std::size_t> states =
      find_states(settings.shared.states, input_names, target_names.size());
  const Attitude attitude = attitude_for(settings.shared.terms, input_names);
  if (const TermSet motion = TermSet::open_loop(input_names, states, attitude); motion.size() > 0) {
    steady.emplace(motion, dimension, states, AttitudeMotion(attitude, input_names, states));
  }
  if (!states.empty() && Diagnosis::terms(dimension, states, attitude) <= kMostTerms) {
    diagnosis.emplace(dimension, states, body_axes(input_names, states), attitude,
                      other_inputs(input_names, states, attitude, true));
  }
  const std::vector<std::size_t> commands = other_inputs(input_names, states, attitude, false);
  if (adapts(settings) && !states.empty() && terms.size() > 0) {
    change.emplace(terms, states, commands);
  }
  if (change || diagnosis) {
    moves.emplace(commands, target_names.size());
  }
  order.reserve(settings.axes.size());
  for (std::size_t i = 0; i < settings.axes.size(); ++i) {
    std::optional<AxisScaling> given;
    if (scaling != nullptr) {
      given = scaling[i];
      require(given->term_scale.size() == terms.size(), "scaling",
              "of " + std::to_string(given->term_scale.size()) + " terms; there are " +
                  std::to_string(terms.size()));
    }
    axes.add(
        make_axis(dimension, settings.shared, settings.axes[i], terms, states, std::move(given)));
  }
}

ModelAxis& DynamicsModel::Parts::axis_at(std::size_t axis) const {
  if (axis >= axes.size()) {
    throw InputError("axis",
                     std::to_string(axis) + " given; there are " + std::to_string(axes.size()));
  }
  return axes[axis];
}

template <typename Holds>
bool DynamicsModel::Parts::all_axes(Holds holds) const {
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (!holds(axes[i])) {
      return false;
    }
  }
  return true;
}

// Axes with unfinished work on the sample before come first.
void DynamicsModel::Parts::order_axes() {
  order.clear();
  for (const bool unfinished : {true, false}) {
    for (std::size_t i = 0; i < axes.size(); ++i) {
      if (axes[i].unfinished() == unfinished) {
        order.push_back(i);
      }
    }
  }
}

// The last sample, on all axes: what is of the vehicle, not of an axis, learns only such samples.
bool DynamicsModel::Parts::trusts_sample() const {
  return all_axes([](const ModelAxis& axis) { return axis.trusted_last(); }) &&
         std::ranges::none_of(state.decisions, is_refused);
}

// Nothing that was compared at rest is of the vehicle that sets off: not the usual errors, and not
// the number of rows.
void DynamicsModel::Parts::begin_with_the_moves(std::span<const double> x,
                                                std::span<const double> y) {
  if (!moves || !trusts_sample() || !moves->update(x, y, state.decisions)) {
    return;
  }
  if (change) {
    change->begin_again();
  }
  if (diagnosis) {
    diagnosis->restart();
  }
}

// All axes together show a change of the vehicle; the members of all axes follow.
void DynamicsModel::Parts::monitor_change(std::span<const double> x, std::span<const double> y,
                                          double t) {
  if (!change) {
    return;
  }
  if (std::ranges::any_of(state.decisions, is_news)) {
    change->restart();
  } else if (trusts_sample() && std::ranges::all_of(state.decisions, is_settled)) {
    apply_change(change->update(x, y, t));
  }
}

// The diagnosis names a thruster by its own equations of motion and on a window of its own, often
// before the monitor knows the vehicle well enough to compare. On more rows the diagnosis may name
// another cause, or take the finding back.
void DynamicsModel::Parts::believe_diagnosis() {
  const std::span<const Finding> findings = diagnosis->findings();
  if (const std::optional<std::size_t> command = change->named_command();
      command && !still_named(findings, *command, change->since())) {
    apply_change(change->disbelieve_cause());
  }
  if (findings.empty()) {
    return;
  }
  const Finding& last = findings.back();
  if (last.state != FindingState::named || last.since_s <= named_since_s) {
    return;
  }
  named_since_s = last.since_s;
  if (last.count == 1) {
    Cause cause = last.causes.front();
    cause.size /= last.before.front();
    apply_change(change->believe_cause(cause, last.since_s));
  }
}

void DynamicsModel::Parts::apply_change(ChangeMonitor::Event event) {
  auto& decisions = state.decisions;
  if (event == ChangeMonitor::Event::none) {
    return;
  }
  if (steady && change->by_gain()) {
    steady->amplify(change->gains());
  }
  for (std::size_t i = 0; i < axes.size(); ++i) {
    decisions[i].changed = event == ChangeMonitor::Event::changed;
    decisions[i].withdrawn = event == ChangeMonitor::Event::withdrawn;
    decisions[i].changed_since = decisions[i].changed ? change->since() : 0.0;
    axes[i].apply_change(change->gains(), change->step(i), decisions[i]);
  }
}

void DynamicsModel::Parts::update_diagnosis(std::span<const double> x, std::span<const double> y,
                                            double t) {
  if (!diagnosis || !trusts_sample()) {
    return;
  }
  diagnosis->update(x, y, t);
  if (change) {
    believe_diagnosis();
  }
}

void DynamicsModel::Parts::observe_steady(std::span<const double> x, std::span<const double> y,
                                          double t) {
  if (!steady) {
    return;
  }
  if (std::ranges::any_of(state.decisions, &Decision::changed)) {
    steady->restart();
  }
  if (!trusts_sample()) {
    return;
  }
  const Accelerations learned = [this](std::span<const double> at, std::span<double> a) {
    for (std::size_t i = 0; i < axes.size(); ++i) {
      a[i] = axes[i].predict(at);
    }
  };
  const bool ready = std::ranges::all_of(state.decisions, is_settled);
  steady->observe(x, y, t, ready ? learned : Accelerations{});
}

void DynamicsModel::Parts::visit(Archive& archive) {
  archive.same("version", kStateVersion);
  archive.same("inputs", join_text(input_names, ", "));
  archive.same("targets", join_text(target_names, ", "));
  for (const auto& [name, value] : settings.values()) {
    archive.same(name, value);
  }
  for (std::size_t i = 0; i < axes.size(); ++i) {
    archive.part(target_names[i], axes[i]);
  }
  archive.part("clock", state.clock);
  archive.part("work", work);
  if (moves) {
    archive.part("moves", *moves);
  }
  if (change) {
    archive.part("change", *change);
  }
  if (steady) {
    archive.part("steady", *steady);
  }
  if (diagnosis) {
    archive.part("diagnosis", *diagnosis);
    archive.any_number(named_since_s);
  }
}

DynamicsModel::DynamicsModel(std::vector<std::string> inputs, std::vector<std::string> targets,
                             const ModelSettings& settings)
    : parts_(std::make_unique<Parts>(std::move(inputs), std::move(targets), settings, nullptr)) {}

DynamicsModel::DynamicsModel(std::vector<std::string> inputs, std::vector<std::string> targets,
                             const ModelSettings& settings, std::span<const AxisScaling> scaling) {
  require(scaling.size() == settings.axes.size(), "scaling", "one per target is needed");
  parts_ = std::make_unique<Parts>(std::move(inputs), std::move(targets), settings, scaling.data());
}

DynamicsModel::DynamicsModel(const DynamicsModel& other)
    : OnlineModel(other), parts_(std::make_unique<Parts>(*other.parts_)) {}
DynamicsModel::DynamicsModel(DynamicsModel&& other) noexcept = default;
DynamicsModel& DynamicsModel::operator=(const DynamicsModel& other) {
  return *this = DynamicsModel(other);
}
DynamicsModel& DynamicsModel::operator=(DynamicsModel&& other) noexcept = default;
DynamicsModel::~DynamicsModel() = default;

std::size_t DynamicsModel::bytes(std::span<const std::string> inputs,
                                 const ModelSettings& settings) {
  const TermSet terms = TermSet::from(settings.shared.terms, inputs, settings.axes.size());
  const auto bytes_of = [&](const OnlineSvrSettings& axis) {
    return settings.shared.learner == LearnerKind::svr
               ? SvrAxis::bytes(inputs.size(), terms.size(), axis)
               : PosteriorAxis::bytes(inputs.size(), terms.size(), axis);
  };
  return std::transform_reduce(settings.axes.begin(), settings.axes.end(), std::size_t{0},
                               std::plus<>{}, bytes_of);
}

// The way of a sample (docs/reference/architecture.md).
void DynamicsModel::update(std::span<const double> x, std::span<const double> y, double t,
                           const AxisDone& done) {
  Parts& model = *parts_;
  UpdateState& state = model.state;
  const AccessGuard::Writer writer(state.access);
  require_size("x", x.size(), inputs());
  require_size("y", y.size(), axes());
  const double now = state.clock.at(t);
  model.order_axes();
  for (std::size_t k = 0; k < axes(); ++k) {
    const std::size_t i = model.order[k];
    ModelAxis& axis = model.axes[i];
    axis.limit(model.work.grant(model.budget, axes() - 1 - k));
    state.decisions[i] = axis.update(x, y[i], now);  // check, scale, predict, learn, score
    if (done) {
      done(i);
    }
  }
  state.share_changes([&](std::size_t i) -> OnlineRegressor& { return model.axes[i]; });
  model.begin_with_the_moves(x, y);
  model.monitor_change(x, y, now);
  model.work.learned(state.crowded_out());
  for (std::size_t i = 0; i < axes(); ++i) {
    model.axes[i].limit(model.budget);  // a grant is good for one update only
  }
  model.update_diagnosis(x, y, now);
  model.observe_steady(x, y, now);
  state.stamp_changes();
}

void DynamicsModel::learn_held_back() {
  const AccessGuard::Writer writer(parts_->state.access);
  for (std::size_t i = 0; i < axes(); ++i) {
    parts_->axes[i].learn_held_back();
  }
}

void DynamicsModel::limit(const Budget& budget) {
  const AccessGuard::Writer writer(parts_->state.access);
  parts_->budget = budget;
}

std::size_t DynamicsModel::inputs() const {
  return parts_->input_names.size();
}

std::span<const Decision> DynamicsModel::decisions() const {
  return parts_->state.decisions;
}

const OnlineRegressor& DynamicsModel::axis(std::size_t axis) const {
  return parts_->axis_at(axis);
}

const ModelAxis& DynamicsModel::mechanisms(std::size_t axis) const {
  return parts_->axis_at(axis);
}

void DynamicsModel::predict(std::span<const double> x, std::span<double> y) const {
  const AccessGuard::Reader reader(parts_->state.access);
  answer(x, inputs(), y, axes(), [&](std::size_t i) { return parts_->axes[i].predict(x); });
}

void DynamicsModel::predict_with_jacobian(std::span<const double> x, std::span<double> y,
                                          std::span<double> jacobian) const {
  const AccessGuard::Reader reader(parts_->state.access);
  answer(x, inputs(), y, axes(), jacobian, [&](std::size_t i, std::span<double> gradient) {
    return parts_->axes[i].predict_with_gradient(x, gradient);
  });
}

void DynamicsModel::predict(std::span<const double> x, std::span<Prediction> y,
                            double ahead_s) const {
  const AccessGuard::Reader reader(parts_->state.access);
  answer(x, inputs(), y, axes(), [&](std::size_t i) { return parts_->axes[i].assess(x, ahead_s); });
}

const Diagnosis* DynamicsModel::diagnosis() const {
  return parts_->diagnosis ? &*parts_->diagnosis : nullptr;
}

std::vector<Finding> DynamicsModel::findings() const {
  const AccessGuard::Reader reader(parts_->state.access);
  std::vector<Finding> findings;
  if (parts_->diagnosis) {
    findings = parts_->diagnosis->findings();
  }
  for (Finding& finding : findings) {
    for (double* const time : {&finding.since_s, &finding.found_s, &finding.told_s}) {
      *time = parts_->state.clock.stamp(*time);
    }
  }
  return findings;
}

std::vector<StoredPastModel> DynamicsModel::past_models(std::size_t axis) const {
  const AccessGuard::Reader reader(parts_->state.access);
  return parts_->axis_at(axis).past_models();
}

void DynamicsModel::set_past_models(std::size_t axis, std::vector<StoredPastModel> models) {
  const AccessGuard::Writer writer(parts_->state.access);
  parts_->axis_at(axis).set_past_models(std::move(models));
}

bool DynamicsModel::ready() const {
  return parts_->all_axes([](const ModelAxis& axis) { return axis.status().ready; });
}

std::string DynamicsModel::save() const {
  const AccessGuard::Reader reader(parts_->state.access);
  Archive archive;
  parts_->visit(archive);  // reads only
  return archive.bytes();
}

DynamicsModel DynamicsModel::resume(DynamicsModel fresh, std::string_view saved) {
  Archive archive(saved);
  fresh.parts_->visit(archive);
  archive.finish();
  return fresh;
}

DynamicsModel DynamicsModel::resume_from(const TrainedModel& trained, double start_s) {
  DynamicsModel model(trained.input_names, trained.target_names(), trained.settings);
  const std::size_t terms = model.mechanisms(0).terms().size();
  for (std::size_t i = 0; i < trained.axes.size(); ++i) {
    const Snapshot& axis = trained.axes[i];
    require(axis.scaling.term_scale.size() == terms, "terms",
            "give " + std::to_string(terms) + " physics terms; the trained model has " +
                std::to_string(axis.scaling.term_scale.size()));
    model.parts_->axes[i].resume_from(axis, start_s);
  }
  return model;
}

TrainedModel DynamicsModel::trained() const {
  const AccessGuard::Reader reader(parts_->state.access);
  TrainedModel model(parts_->input_names, parts_->settings, parts_->axes[0].terms(), {});
  for (std::size_t i = 0; i < parts_->axes.size(); ++i) {
    model.axes.push_back(parts_->axes[i].trained(parts_->target_names[i]));
    if (parts_->steady) {
      model.axes.back().steady = parts_->steady->model(i);
    }
  }
  return model;
}

void set_nominal(DynamicsModel& model, std::size_t axis, std::span<const Coefficient> known) {
  const AccessGuard::Writer writer(model.parts_->state.access);
  ModelAxis& learner = model.parts_->axis_at(axis);
  if (!known.empty()) {
    learner.expect_vehicle(coefficients_of(known, learner.terms()));
  }
}

}  // namespace kelpie
