// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include "live_model.hpp"

namespace kelpie::python {

void bind_live_model(py::module_& module) {
  PYBIND11_NUMPY_DTYPE_EX(
      Decision, verdict, "verdict", prediction.value, "predicted", had_model, "had_model",
      prediction.lower, "lower", prediction.upper, "upper", prediction.disturbance, "disturbance",
      prediction.corrected_lower, "corrected_lower", prediction.corrected_upper, "corrected_upper",
      similarity, "similarity", outliers, "outliers", forgotten, "forgotten", released, "released",
      iterations, "iterations", kkt_gap, "kkt_gap", published, "served", rejected_by_tolerance,
      "unserved", unfinished, "unfinished", fallbacks, "fallbacks", changed, "changed",
      changed_since, "changed_since", recalled, "recalled", withdrawn, "withdrawn");
  PYBIND11_NUMPY_DTYPE(Prediction, value, lower, upper, novelty, disturbance, corrected_lower,
                       corrected_upper);
  module.attr("decision_dtype") = py::dtype::of<Decision>();
  module.attr("prediction_dtype") = py::dtype::of<Prediction>();

  py::class_<LiveModel>(module, "LiveModel",
                        "A model that learns. Arrays are float64 in C order and aren't copied; "
                        "other threads run meanwhile.")
      .def(py::init<std::vector<std::string>, std::vector<std::string>, const SettingTexts&>(),
           py::arg("inputs"), py::arg("targets"), py::arg("settings"),
           "Names of inputs and targets, and settings as text by name. ValueError on wrong ones.")
      .def_static("resume_from", &LiveModel::resume_from, py::arg("trained"), py::arg("start_s"),
                  "A model that goes on learning where a trained one stands, from that time [s].")
      .def("set_nominal", &LiveModel::set_nominal, py::arg("target"), py::arg("coefficients"),
           "Begins with coefficients of a target's terms, by their text.")
      .def("set_nominal_models", &LiveModel::set_nominal_models, py::arg("models"),
           "Begins with the mean of earlier models.")
      .def(
          "update", &LiveModel::update, py::arg("X").noconvert(), py::arg("y").noconvert(),
          py::arg("t").noconvert(),
          "Learns X (n, inputs), y (n, axes) at the times t (n,) [s]. Returns decisions (n, axes).")
      .def("learn_held_back", &LiveModel::learn_held_back,
           "Learns at once what is still held back although the scale is known.")
      .def("predict", &LiveModel::predict, py::arg("X").noconvert(), "(n, axes)")
      .def(
          "assess", &LiveModel::assess, py::arg("X").noconvert(), py::arg("ahead_s").noconvert(),
          "Value, interval, novelty and disturbance `ahead_s` (n,) [s] after the last row learned, "
          "a structured array (n, axes).")
      .def("predict_with_jacobian", &LiveModel::predict_with_jacobian, py::arg("X").noconvert(),
           "Predictions (n, axes) and derivatives (n, axes, inputs).")
      .def("status", &LiveModel::status, "Buffer and totals of every axis.")
      .def("diagnosis", &LiveModel::diagnosis,
           "What became of the vehicle, and how its thrusters do; None where it can't be told.")
      .def("authority", &LiveModel::authority, py::arg("ranges"),
           "What the thrusters can still do, with commands between (input, least, most).")
      .def("coefficients", &LiveModel::coefficients,
           "Of the physics terms, (axes, terms); NaN before there is a model.")
      .def("trained", &LiveModel::trained,
           "A copy of the models in service. ValueError where there is none yet.")
      .def_property_readonly("inputs", &LiveModel::inputs)
      .def_property_readonly("targets", &LiveModel::targets)
      .def_property_readonly("settings", &LiveModel::settings)
      .def_property_readonly("terms", &LiveModel::terms)
      .def_property_readonly(
          "alignment_s", &LiveModel::alignment_s,
          "How much later the commands stood in the rows of the model it went on with [s].")
      .def_property_readonly("actuators", &LiveModel::actuators,
                             "Of the same commands; a dict each.")
      .def_property_readonly("samples", &LiveModel::samples)
      .def(py::pickle([](const LiveModel& model) { return model.state(); },
                      [](const py::tuple& state) { return LiveModel::resume(state); }));
}

}  // namespace kelpie::python
