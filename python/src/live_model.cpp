// SPDX-License-Identifier: Apache-2.0
#include "live_model.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <limits>
#include <mutex>
#include <utility>

#include "core/text.hpp"
#include "file/json.hpp"
#include "files/model_json.hpp"
#include "format/checkpoint_file.hpp"
#include "format/model_parts.hpp"
#include "kelpie/model/trained_model.hpp"
#include "kelpie/motion/term_set.hpp"
#include "kelpie/vehicle/diagnosis.hpp"
#include "model/model_axis.hpp"
#include "study/nominal.hpp"

namespace kelpie::python {
namespace {

constexpr const char* kStateName = "state of a kelpie model";  // in messages
constexpr const char* kStateHeader = R"({"kelpie": ")" KELPIE_VERSION R"(", "kind": "python"})";
constexpr std::size_t kStateParts = 6;

py::dict status_dict(const Status& status) {
  using namespace py::literals;  // NOLINT(google-build-using-namespace): "name"_a has no other way
  py::dict dict("ready"_a = status.ready, "buffer"_a = status.buffer,
                "support_vectors"_a = status.support_vectors, "kkt_gap"_a = status.kkt_gap);
  for (const TallyField& field : tally_fields()) {
    dict[py::str(std::string(field.name))] = status.tally.*field.total;
  }
  return dict;
}

py::dict cause_dict(const Cause& cause, const DiagnosisNames& names) {
  using namespace py::literals;  // NOLINT(google-build-using-namespace): as above
  return py::dict("kind"_a = kind_name(cause.kind), "column"_a = cause_column(cause, names),
                  "size"_a = cause.size, "lower"_a = cause.lower, "upper"_a = cause.upper);
}

py::list cause_list(std::span<const Cause> causes, const DiagnosisNames& names) {
  py::list list;
  std::ranges::for_each(causes, [&](const Cause& cause) { list.append(cause_dict(cause, names)); });
  return list;
}

// Causes of a finding, with the share of a thruster before the change.
py::list changed_list(const Finding& finding, const DiagnosisNames& names) {
  py::list list;
  for (std::size_t i = 0; i < finding.count; ++i) {
    py::dict cause = cause_dict(finding.causes[i], names);
    if (finding.causes[i].kind == CauseKind::thruster) {
      cause["before"] = finding.before[i];
    }
    list.append(cause);
  }
  return list;
}

py::dict finding_dict(const Finding& finding, const DiagnosisNames& names) {
  using namespace py::literals;  // NOLINT(google-build-using-namespace): as above
  const bool judged = finding.state != FindingState::looking;
  return py::dict("since_s"_a = finding.since_s, "found_s"_a = finding.found_s,
                  "told_s"_a = finding.told_s, "state"_a = state_name(finding.state),
                  "settled"_a = finding.settled, "text"_a = finding_text(finding, names),
                  "causes"_a = judged ? changed_list(finding, names) : py::list(),
                  "margin"_a = finding.margin, "explained"_a = finding.explained);
}

}  // namespace

LiveModel::LiveModel(std::vector<std::string> inputs, std::vector<std::string> targets,
                     const SettingTexts& settings)
    : inputs_(std::move(inputs)),
      targets_(std::move(targets)),
      settings_(texts_of(settings_from(settings, targets_.size()))),
      model_(inputs_, targets_, settings_from(settings_, targets_.size())) {}

LiveModel::LiveModel(std::vector<std::string> inputs, std::vector<std::string> targets,
                     SettingTexts settings, DynamicsModel model, std::int64_t samples,
                     Alignment alignment)
    : inputs_(std::move(inputs)),
      targets_(std::move(targets)),
      settings_(std::move(settings)),
      model_(std::move(model)),
      alignment_(std::move(alignment)),
      samples_(samples) {}

py::array_t<Decision> LiveModel::update(const Array& x, const Array& y, const Array& t) {
  const Rows inputs(x, model_.inputs(), "X");
  const Rows targets(y, model_.axes(), "y");
  const Rows times(t, 1, "t");
  targets.require_size(inputs.size(), "y");
  times.require_size(inputs.size(), "t");
  py::array_t<Decision> decisions({extent(inputs.size()), extent(model_.axes())});
  Decision* const out = decisions.mutable_data();
  turns_.require_whole();
  for_rows(
      inputs.size(), [this] { return std::unique_lock(turns_.mutex); },
      [&](std::size_t row) {
        model_.update(inputs[row], targets[row], times[row][0]);
        std::ranges::copy(model_.decisions(), row_of(out, row, model_.axes()).begin());
        ++samples_;
      });
  return decisions;
}

Array LiveModel::predict(const Array& x) const {
  const Rows inputs(x, model_.inputs(), "X");
  Array predicted({extent(inputs.size()), extent(model_.axes())});
  double* const out = predicted.mutable_data();
  for_rows(inputs.size(), reading(),
           [&](std::size_t row) { model_.predict(inputs[row], row_of(out, row, model_.axes())); });
  return predicted;
}

py::array_t<Prediction> LiveModel::assess(const Array& x, const Array& ahead_s) const {
  const Rows inputs(x, model_.inputs(), "X");
  const Rows ahead(ahead_s, 1, "ahead_s");
  ahead.require_size(inputs.size(), "ahead_s");
  py::array_t<Prediction> predicted({extent(inputs.size()), extent(model_.axes())});
  Prediction* const out = predicted.mutable_data();
  for_rows(inputs.size(), reading(), [&](std::size_t row) {
    model_.predict(inputs[row], row_of(out, row, model_.axes()), ahead[row][0]);
  });
  return predicted;
}

py::tuple LiveModel::predict_with_jacobian(const Array& x) const {
  const Rows inputs(x, model_.inputs(), "X");
  const std::size_t slopes = model_.axes() * model_.inputs();
  Array predicted({extent(inputs.size()), extent(model_.axes())});
  Array jacobian({extent(inputs.size()), extent(model_.axes()), extent(model_.inputs())});
  double* const value = predicted.mutable_data();
  double* const slope = jacobian.mutable_data();
  for_rows(inputs.size(), reading(), [&](std::size_t row) {
    model_.predict_with_jacobian(inputs[row], row_of(value, row, model_.axes()),
                                 row_of(slope, row, slopes));
  });
  return py::make_tuple(predicted, jacobian);
}

py::list LiveModel::status() const {
  std::vector<Status> found;
  {
    const ReadingTurn turn(turns_);
    for (std::size_t axis = 0; axis < model_.axes(); ++axis) {
      found.push_back(model_.axis(axis).status());
    }
  }
  py::list list;
  std::ranges::for_each(found, [&](const Status& status) { list.append(status_dict(status)); });
  return list;
}

py::object LiveModel::diagnosis() const {
  using namespace py::literals;  // NOLINT(google-build-using-namespace): as above
  if (model_.diagnosis() == nullptr) {
    return py::none();
  }
  std::vector<Finding> findings;
  std::vector<Cause> health;
  {
    const ReadingTurn turn(turns_);
    findings = model_.findings();
    health = model_.diagnosis()->health();
  }
  const DiagnosisNames names{inputs_, targets_};
  py::list list;
  std::ranges::for_each(findings,
                        [&](const Finding& finding) { list.append(finding_dict(finding, names)); });
  return py::dict("findings"_a = list, "health"_a = cause_list(health, names));
}

Authority LiveModel::authority(
    const std::vector<std::tuple<std::string, double, double>>& ranges) const {
  require(model_.diagnosis() != nullptr, "model", "doesn't know its velocities (states)");
  std::vector<CommandRange> commands;
  for (const auto& [name, least, most] : ranges) {
    const auto found = std::ranges::find(inputs_, name);
    require(found != inputs_.end(), "ranges", "'" + name + "' is no input");
    commands.push_back(
        {.input = static_cast<std::size_t>(found - inputs_.begin()), .least = least, .most = most});
  }
  const ReadingTurn turn(turns_);
  return {*model_.diagnosis(), std::move(commands)};
}

std::vector<std::string> LiveModel::terms() const {
  const TermSet& terms = model_.mechanisms(0).terms();
  std::vector<std::string> texts;
  for (std::size_t k = 0; k < terms.size(); ++k) {
    texts.push_back(terms.text(k));
  }
  return texts;
}

Array LiveModel::coefficients() const {
  const std::size_t terms = model_.mechanisms(0).terms().size();
  Array values({extent(model_.axes()), extent(terms)});
  double* const out = values.mutable_data();
  std::fill_n(out, values.size(), std::numeric_limits<double>::quiet_NaN());
  const ReadingTurn turn(turns_);
  for (std::size_t axis = 0; axis < model_.axes(); ++axis) {
    if (model_.axis(axis).status().ready) {
      std::ranges::transform(model_.axis(axis).coefficients(), row_of(out, axis, terms).begin(),
                             &Coefficient::value);
    }
  }
  return values;
}

TrainedModel LiveModel::trained() const {
  const ReadingTurn turn(turns_);
  if (!model_.ready()) {
    throw InputError("too few rows so far for a model to keep, or rows that are all alike");
  }
  TrainedModel trained = model_.trained();
  trained.alignment = alignment_;
  return trained;
}

std::int64_t LiveModel::samples() const {
  const ReadingTurn turn(turns_);
  return samples_;
}

void LiveModel::set_nominal(const std::string& target,
                            const std::map<std::string, double>& coefficients) {
  const auto found = std::ranges::find(targets_, target);
  require(found != targets_.end(), "nominal",
          "'" + target + "' is no target; targets are " + join_text(targets_, ", "));
  std::vector<Coefficient> known;
  for (const auto& [term, value] : coefficients) {
    known.push_back({term, value});
  }
  kelpie::set_nominal(model_, static_cast<std::size_t>(found - targets_.begin()), known);
}

void LiveModel::set_nominal_models(const std::vector<TrainedModel>& models) {
  const TermSet& terms = model_.mechanisms(0).terms();
  std::vector<study::Nominal> all;
  for (const TrainedModel& model : models) {
    all.push_back(study::nominal_of(model, targets_, terms, "nominal"));
  }
  study::give(study::mean_of(all), model_);
}

py::tuple LiveModel::state() const {
  std::string state;
  std::int64_t samples = 0;
  {
    const ReadingTurn turn(turns_);
    samples = samples_;
    state = format::checkpoint_bytes({.header = kStateHeader, .state = model_.save()});
  }
  const py::tuple alignment =
      py::make_tuple(alignment_.lag_s, alignment_.rows, alignment_.commands, actuators(),
                     file::json_text(format::alignment_json(alignment_)));
  return py::make_tuple(inputs_, targets_, settings_, samples, alignment, py::bytes(state));
}

std::unique_ptr<LiveModel> LiveModel::resume(const py::tuple& state) {
  if (state.size() != kStateParts) {
    throw InputError(std::string("this is no ") + kStateName);
  }
  const auto inputs = state[0].cast<std::vector<std::string>>();
  const auto targets = state[1].cast<std::vector<std::string>>();
  const auto settings = state[2].cast<SettingTexts>();
  const format::Checkpoint found =
      format::parse_checkpoint(state[5].cast<std::string>(), kStateName);
  const auto alignment = state[4].cast<py::tuple>();
  Alignment known{.lag_s = alignment[0].cast<double>(),
                  .rows = alignment[1].cast<int>(),
                  .commands = alignment[2].cast<std::vector<std::string>>(),
                  .actuators = actuators_from(alignment[3].cast<std::vector<py::dict>>())};
  if (alignment.size() > 4) {  // states of older versions know of no current
    const file::Json json = file::parse_json(alignment[4].cast<std::string>(), kStateName);
    known.water = read_alignment(JsonNode(json, kStateName, ""), inputs, targets.size()).water;
  }
  return std::unique_ptr<LiveModel>(new LiveModel(
      inputs, targets, settings,
      DynamicsModel::resume(DynamicsModel(inputs, targets, settings_from(settings, targets.size())),
                            found.state),
      state[3].cast<std::int64_t>(), std::move(known)));
}

std::unique_ptr<LiveModel> LiveModel::resume_from(const TrainedModel& trained, double start_s) {
  return std::unique_ptr<LiveModel>(
      new LiveModel(trained.input_names, trained.target_names(), texts_of(trained.settings),
                    DynamicsModel::resume_from(trained, start_s), 0, trained.alignment));
}

}  // namespace kelpie::python
