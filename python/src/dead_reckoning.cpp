// SPDX-License-Identifier: Apache-2.0
#include "kelpie/navigation/dead_reckoning.hpp"

#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <vector>

#include "bindings.hpp"
#include "kelpie/model/trained_model.hpp"
#include "navigation/named_settings.hpp"
#include "rows.hpp"

namespace kelpie::python {
namespace {

CommandPath path_of(bool held) {
  return held ? CommandPath::held : CommandPath::linear;
}

DeadReckoning make_reckoning(const TrainedModel& model, std::optional<bool> planar,
                             double current_m_s, double practice_s, bool held, double step_s,
                             bool checks) {
  const OpenLoop loop = open_loop(model, OpenLoopPart::steady);
  DeadReckoningSettings settings = named_settings(loop);
  // Columns without names are x0, x1, x2: three velocities are those of the plane.
  const bool by_default = settings.planar || (loop.states.size() == 3 && may_be_planar(loop));
  settings.step_s = step_s;
  settings.between = path_of(held);
  settings.planar = planar.value_or(by_default);
  settings.current_m_s = current_m_s;
  settings.practice_s = practice_s;
  settings.checks = checks;
  return DeadReckoning(loop, settings);
}

void update(DeadReckoning& reckoning, const Array& x, double t, const Array& covariance) {
  reckoning.update({x.data(), static_cast<std::size_t>(x.size())}, t,
                   {covariance.data(), static_cast<std::size_t>(covariance.size())});
}

void restate(DeadReckoning& reckoning, const Array& x, bool held) {
  reckoning.restate({x.data(), static_cast<std::size_t>(x.size())}, path_of(held));
}

Array velocity(const DeadReckoning& reckoning) {
  Array values(extent(reckoning.states()));
  for (std::size_t i = 0; i < reckoning.states(); ++i) {
    values.mutable_data()[i] = reckoning.velocity(i);
  }
  return values;
}

Array covariance(const DeadReckoning& reckoning) {
  const std::size_t states = reckoning.states();
  Array values({extent(states), extent(states)});
  for (std::size_t i = 0; i < states * states; ++i) {
    values.mutable_data()[i] = reckoning.covariance(i / states, i % states);
  }
  return values;
}

std::vector<std::string> faults(const DeadReckoning& reckoning) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < reckoning.states(); ++i) {
    names.emplace_back(fault_name(reckoning.fault(i)));
  }
  return names;
}

}  // namespace

void bind_dead_reckoning(py::module_& module) {
  py::class_<DeadReckoning>(module, "DeadReckoning",
                            "Velocities while they are measured, and while they aren't.")
      .def(py::init(&make_reckoning), py::arg("model"), py::arg("planar"), py::arg("current_m_s"),
           py::arg("practice_s"), py::arg("held"), py::arg("step_s"), py::arg("checks"))
      .def("update", &update, py::arg("x").noconvert(), py::arg("t"),
           py::arg("covariance").noconvert(), "One sample; NaN: not measured.")
      .def("measured_heading", &DeadReckoning::measured_heading, py::arg("heading"),
           py::arg("deviation"))
      .def(
          "use",
          [](DeadReckoning& reckoning, const TrainedModel& model) {
            reckoning.use(open_loop(model, OpenLoopPart::steady));
          },
          py::arg("model"))
      .def("restate", &restate, py::arg("x").noconvert(), py::arg("held"))
      .def_property_readonly("faults", &faults)
      .def_property_readonly("step", &DeadReckoning::step)
      .def_property_readonly("started", &DeadReckoning::started)
      .def_property_readonly("silent_s", &DeadReckoning::silent_s)
      .def_property_readonly("velocity", &velocity)
      .def_property_readonly("covariance", &covariance)
      .def_property_readonly("heading", &DeadReckoning::heading)
      .def_property_readonly("current", &DeadReckoning::current)
      .def_property_readonly("position",
                             [](const DeadReckoning& r) { return r.drift().position_m; })
      .def_property_readonly("position_covariance",
                             [](const DeadReckoning& r) { return r.drift().covariance_m2; })
      .def_property_readonly("noise_factor", &DeadReckoning::noise_factor);
}

}  // namespace kelpie::python
