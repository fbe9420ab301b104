// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <string>
#include <vector>

#include "bindings.hpp"
#include "kelpie/vehicle/diagnosis.hpp"
#include "rows.hpp"

namespace kelpie::python {
namespace {

// Accelerations per axis and thruster.
Array matrix(const Authority& authority, std::vector<double> ThrusterEffect::*values) {
  const std::size_t thrusters = authority.thrusters().size();
  Array columns({extent(authority.axes().size()), extent(thrusters)});
  for (std::size_t k = 0; k < thrusters; ++k) {
    const std::vector<double>& column = authority.thrusters()[k].*values;
    for (std::size_t i = 0; i < column.size(); ++i) {
      columns.mutable_data()[i * thrusters + k] = column[i];
    }
  }
  return columns;
}

template <auto kValues>
auto matrix_property() {
  return [](const Authority& authority) { return matrix(authority, kValues); };
}

py::list axes(const Authority& authority) {
  using namespace py::literals;  // NOLINT(google-build-using-namespace): as pybind11 has it
  py::list list;
  for (const AxisAuthority& axis : authority.axes()) {
    list.append(py::dict("most"_a = axis.most, "least"_a = axis.least,
                         "nominal_most"_a = axis.nominal_most,
                         "nominal_least"_a = axis.nominal_least, "alone_most"_a = axis.alone_most,
                         "alone_least"_a = axis.alone_least, "left"_a = axis.left()));
  }
  return list;
}

std::vector<double> shares(const Authority& authority) {
  std::vector<double> all;
  for (const ThrusterEffect& one : authority.thrusters()) {
    all.push_back(one.share);
  }
  return all;
}

py::tuple allocate(const Authority& authority, const std::vector<double>& wanted) {
  const Allocation allocation = authority.allocate(wanted);
  return py::make_tuple(allocation.commands, allocation.reached, allocation.missing);
}

}  // namespace

void bind_authority(py::module_& module) {
  py::class_<Authority>(module, "Authority", "What the thrusters can still do.")
      .def("allocate", &allocate, py::arg("wanted"),
           "Commands, accelerations reached, and the largest part that isn't reached.")
      .def(
          "text",
          [](const Authority& authority, const std::vector<std::string>& inputs,
             const std::vector<std::string>& targets) {
            return authority.text({inputs, targets});
          },
          py::arg("inputs"), py::arg("targets"))
      .def_property_readonly("ahead", matrix_property<&ThrusterEffect::ahead>())
      .def_property_readonly("astern", matrix_property<&ThrusterEffect::astern>())
      .def_property_readonly("ahead_width", matrix_property<&ThrusterEffect::ahead_width>())
      .def_property_readonly("astern_width", matrix_property<&ThrusterEffect::astern_width>())
      .def_property_readonly("shares", &shares)
      .def_property_readonly("axes", &axes)
      .def_property_readonly("singular_values", &Authority::singular_values)
      .def_property_readonly("nominal_singular_values", &Authority::nominal_singular_values)
      .def_property_readonly("lost_axis", &Authority::lost_axis)
      .def_property_readonly("held_current", &Authority::held_current);
}

}  // namespace kelpie::python
