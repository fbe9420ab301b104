// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/trained_model.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bindings.hpp"
#include "file/atomic_file.hpp"
#include "format/model_json.hpp"
#include "kelpie/model/rollout.hpp"
#include "model/snapshot.hpp"
#include "rows.hpp"

namespace kelpie::python {
namespace {

constexpr auto kNoLock = [] { return 0; };  // nobody changes a trained model

std::vector<std::string> terms(const TrainedModel& model) {
  std::vector<std::string> texts;
  for (std::size_t k = 0; k < model.terms.size(); ++k) {
    texts.push_back(model.terms.text(k));
  }
  return texts;
}

Array predict(const TrainedModel& model, const Array& x) {
  const Rows inputs(x, model.input_names.size(), "X");
  Array predicted({extent(inputs.size()), extent(model.axes.size())});
  double* const out = predicted.mutable_data();
  for_rows(inputs.size(), kNoLock, [&](std::size_t row) {
    model.predict(inputs[row], row_of(out, row, model.axes.size()));
  });
  return predicted;
}

py::array_t<Prediction> assess(const TrainedModel& model, const Array& x) {
  const Rows inputs(x, model.input_names.size(), "X");
  py::array_t<Prediction> predicted({extent(inputs.size()), extent(model.axes.size())});
  Prediction* const out = predicted.mutable_data();
  for_rows(inputs.size(), kNoLock, [&](std::size_t row) {
    model.predict(inputs[row], row_of(out, row, model.axes.size()));
  });
  return predicted;
}

py::tuple predict_with_jacobian(const TrainedModel& model, const Array& x) {
  const Rows inputs(x, model.input_names.size(), "X");
  const std::size_t axes = model.axes.size();
  const std::size_t slopes = axes * model.input_names.size();
  Array predicted({extent(inputs.size()), extent(axes)});
  Array jacobian({extent(inputs.size()), extent(axes), extent(model.input_names.size())});
  double* const value = predicted.mutable_data();
  double* const slope = jacobian.mutable_data();
  for_rows(inputs.size(), kNoLock, [&](std::size_t row) {
    model.predict_with_jacobian(inputs[row], row_of(value, row, axes), row_of(slope, row, slopes));
  });
  return py::make_tuple(predicted, jacobian);
}

Array coefficients(const TrainedModel& model) {
  Array values({extent(model.axes.size()), extent(model.terms.size())});
  double* out = values.mutable_data();
  for (const TrainedModel::Axis& axis : model.axes) {
    for (std::size_t k = 0; k < model.terms.size(); ++k) {
      *out++ =
          axis.scaling.target.scale * axis.function.term_weight(k) / axis.scaling.term_scale[k];
    }
  }
  return values;
}

// A start and the times that follow it: finite, and each later than the one before, within reach.
void require_course(const Array& x, const Rows& times, double step_s) {
  if (!std::all_of(x.data(), x.data() + x.size(), [](double v) { return std::isfinite(v); })) {
    throw InputError("X", "holds a NaN or an infinity");
  }
  for (std::size_t row = 0; row < times.size(); ++row) {
    if (!std::isfinite(times[row][0]) || (row > 0 && !(times[row][0] > times[row - 1][0]))) {
      throw InputError("t", "has to be finite and to go up from row to row");
    }
    if (row > 0 && times[row][0] - times[row - 1][0] > Rollout::kMostSteps * step_s) {
      throw InputError("t", "goes up by more than a million steps of the integrator at once");
    }
  }
}

py::tuple rollout(const TrainedModel& model, const Array& x, const Array& t, bool held,
                  std::vector<std::size_t> measured, double step_s) {
  const Rows inputs(x, model.input_names.size(), "X");
  const Rows times(t, 1, "t");
  times.require_size(inputs.size(), "t");
  require_course(x, times, step_s);
  Rollout course(open_loop(model), {.step_s = step_s,
                                    .between = held ? CommandPath::held : CommandPath::linear,
                                    .measured = std::move(measured)});
  const std::size_t states = model.axes.size();
  Array velocity({extent(inputs.size()), extent(states)});
  Array spread({extent(inputs.size()), extent(states)});
  py::array_t<bool> beyond(extent(inputs.size()));
  double* const at = velocity.mutable_data();
  double* const around = spread.mutable_data();
  bool* const outside = beyond.mutable_data();
  for_rows(inputs.size(), kNoLock, [&](std::size_t row) {
    if (row == 0) {
      course.start(inputs[row]);
    } else {
      course.advance(inputs[row], times[row][0] - times[row - 1][0]);
    }
    for (std::size_t state = 0; state < states; ++state) {
      at[row * states + state] = course.velocity(state);
      around[row * states + state] = course.spread(state);
    }
    outside[row] = course.beyond();
  });
  return py::make_tuple(velocity, spread, beyond);
}

// A model with what its model.json says besides the model.
struct SavedModel : TrainedModel {
  format::ModelInfo info{};
};

SavedModel parse(const std::string& text, const std::string& source) {
  SavedModel model;
  static_cast<TrainedModel&>(model) = format::parse_model_json(text, source, &model.info);
  return model;
}

SavedModel read(const std::string& file) {
  SavedModel model;
  static_cast<TrainedModel&>(model) = format::read_model(file, &model.info);
  constexpr int kCallersCaller = 2;
  if (!model.info.doubt.empty() &&
      PyErr_WarnEx(PyExc_UserWarning,
                   (file + ": the model is doubtful: " + model.info.doubt).c_str(),
                   kCallersCaller) < 0) {
    throw py::error_already_set();
  }
  return model;
}

SavedModel noted(const TrainedModel& model, const format::ColumnUnits& units,
                 const std::string& doubt) {
  SavedModel saved;
  static_cast<TrainedModel&>(saved) = model;
  saved.info.units = units;
  saved.info.doubt = doubt;
  return saved;
}

std::string json_of(const TrainedModel& model) {
  return format::model_json(model);
}

std::string json_of(const SavedModel& model) {
  return format::model_json(model, model.info);
}

// The text of a model.json, in files and pickles, too; `parse` reads a model from the text.
template <typename Model, typename... Base>
void bind_json(py::class_<Model, Base...>& type,
               Model (*parse)(const std::string& text, const std::string& source)) {
  type.def(
          "json", [](const Model& model) { return json_of(model); }, "The text of a model.json.")
      .def(
          "write",
          [](const Model& model, const std::string& file) {
            file::write_file_whole(file, json_of(model));
          },
          py::arg("file"), "Writes a model.json, whole or not at all; RuntimeError on failure.")
      .def(py::pickle([](const Model& model) { return json_of(model); },
                      [parse](const std::string& text) { return parse(text, "pickle"); }));
}

TrainedModel parse_plain(const std::string& text, const std::string& source) {
  return format::parse_model_json(text, source);
}

void bind_saved_model(py::module_& module) {
  py::class_<SavedModel, TrainedModel> type(
      module, "SavedModel", "A TrainedModel with the units, doubt and logs of its model.json.");
  bind_json(type, &parse);
  type.def_property_readonly("units", [](const SavedModel& model) { return model.info.units; })
      .def_property_readonly(
          "doubt", [](const SavedModel& model) { return model.info.doubt; },
          "What cannot be right in the learned targets; empty without a reason.");
}

}  // namespace

void bind_trained_model(py::module_& module) {
  py::class_<TrainedModel> type(module, "TrainedModel",
                                "A model that no longer learns: what model.json holds.");
  bind_json(type, &parse_plain);
  type.def_static("parse", &parse, py::arg("text"), py::arg("source"),
                  "Reads the text of a model.json; ValueError naming `source` and the key.")
      .def_static("read", &read, py::arg("file"),
                  "Reads a model.json; ValueError naming the file and the key, UserWarning with a "
                  "doubt.")
      .def("noted", &noted, py::arg("units"), py::arg("doubt"),
           "The model with what a model.json says of units and doubt.")
      .def("predict", &predict, py::arg("X").noconvert(), "(n, axes)")
      .def("assess", &assess, py::arg("X").noconvert(),
           "Value, interval and novelty, a structured array (n, axes).")
      .def("predict_with_jacobian", &predict_with_jacobian, py::arg("X").noconvert(),
           "Predictions (n, axes) and derivatives (n, axes, inputs).")
      .def("coefficients", &coefficients, "Of the physics terms, (axes, terms).")
      .def("rollout", &rollout, py::arg("X").noconvert(), py::arg("t").noconvert(), py::arg("held"),
           py::arg("measured"), py::arg("step_s"),
           "Velocities (n, states), their spread (n, states), beyond the range seen (n,).")
      .def_readonly("inputs", &TrainedModel::input_names)
      .def_property_readonly("targets", &TrainedModel::target_names)
      .def_property_readonly("settings",
                             [](const TrainedModel& model) { return texts_of(model.settings); })
      .def_property_readonly("terms", &terms)
      .def_property_readonly(
          "alignment_s", [](const TrainedModel& model) { return model.alignment.lag_s; },
          "How much later the commands stood that the model saw in a row [s].")
      .def_property_readonly(
          "actuators", [](const TrainedModel& model) { return actuators_of(model.alignment); },
          "Through which the model saw the commands; a dict each.");
  bind_saved_model(module);
}

}  // namespace kelpie::python
