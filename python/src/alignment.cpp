// SPDX-License-Identifier: Apache-2.0
#include "kelpie/alignment/alignment.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <string>
#include <vector>

#include "bindings.hpp"
#include "kelpie/core/error.hpp"
#include "rows.hpp"

namespace kelpie::python {
namespace {

constexpr const char* kCommand = "command";

// All rows of X (n, inputs) and y (n, targets) at the times t (n,).
class AllRows {
 public:
  AllRows(const Array& x, const Array& y, const Array& t, double rate_hz,
          std::vector<std::string> inputs, std::string states)
      : rows_(static_cast<std::size_t>(t.size())) {
    std::iota(rows_.begin(), rows_.end(), std::size_t{0});
    const std::size_t targets = y.ndim() == 2 ? static_cast<std::size_t>(y.shape(1)) : 1;
    Rows(x, inputs.size(), "X").require_size(rows_.size(), "X");
    Rows(y, targets, "y").require_size(rows_.size(), "y");
    problem.inputs = span_of(x);
    problem.targets = span_of(y);
    problem.times_s = span_of(t);
    problem.rows = rows_;
    problem.input_names = std::move(inputs);
    problem.target_count = targets;
    problem.states = std::move(states);
    problem.rate_hz = rate_hz;
  }

  AlignmentProblem problem;

 private:
  static std::span<const double> span_of(const Array& array) {
    return {array.data(), static_cast<std::size_t>(array.size())};
  }

  std::vector<std::size_t> rows_;
};

std::vector<std::string> command_names(const Array& x, const Array& y, const Array& t,
                                       double rate_hz, const std::vector<std::string>& inputs,
                                       const std::string& states) {
  const AllRows all(x, y, t, rate_hz, inputs, states);
  std::vector<std::string> names;
  for (const std::size_t command : find_commands(all.problem)) {
    names.push_back(inputs[command]);
  }
  return names;
}

py::tuple find(const Array& x, const Array& y, const Array& t, double rate_hz,
               const std::vector<std::string>& inputs, const std::string& states) {
  const AllRows all(x, y, t, rate_hz, inputs, states);
  const AlignmentResult found = [&] {
    const py::gil_scoped_release release;
    return find_alignment(all.problem);
  }();
  return py::make_tuple(found.alignment.lag_s, found.alignment.commands,
                        actuators_of(found.alignment), found.gain, found.why);
}

Array align(const Array& x, const Array& t, double rate_hz, int rows,
            const std::vector<std::size_t>& commands, const std::vector<py::dict>& actuators) {
  const auto width = static_cast<std::size_t>(x.shape(1));
  const Rows inputs(x, width, "X");
  inputs.require_size(static_cast<std::size_t>(t.size()), "X");
  AlignedRows stream(rows, commands, width, 0, rate_hz, actuators_from(actuators));
  Array aligned({x.shape(0), x.shape(1)});
  double* out = aligned.mutable_data();
  const auto take = [&](std::span<const double> row, std::span<const double>, double) {
    out = std::ranges::copy(row, out).out;
  };
  for (std::size_t row = 0; row < inputs.size(); ++row) {
    stream.push(inputs[row], {}, t.data()[row], take);
  }
  stream.finish(take);
  return aligned;
}

Actuator actuator_from(const py::dict& given) {
  Actuator actuator;
  for (const auto& [key, value] : given) {
    const auto name = key.cast<std::string>();
    const auto field = std::ranges::find(Actuator::fields(), name, &Actuator::Field::name);
    if (field != Actuator::fields().end()) {
      actuator.*field->number = value.cast<double>();
    } else if (name != kCommand) {
      throw InputError("actuators", "have no '" + name + "'");
    }
  }
  return actuator;
}

}  // namespace

py::list actuators_of(const Alignment& alignment) {
  py::list list;
  for (std::size_t k = 0; k < alignment.actuators.size(); ++k) {
    py::dict entry;
    entry[kCommand] = alignment.commands[k];
    for (const Actuator::Field& field : Actuator::fields()) {
      entry[py::str(field.name)] = alignment.actuators[k].*field.number;
    }
    list.append(entry);
  }
  return list;
}

std::vector<Actuator> actuators_from(const std::vector<py::dict>& given) {
  std::vector<Actuator> actuators;
  std::ranges::transform(given, std::back_inserter(actuators), actuator_from);
  return actuators;
}

void bind_alignment(py::module_& module) {
  module.def("find_commands", &command_names, py::arg("X").noconvert(), py::arg("y").noconvert(),
             py::arg("t").noconvert(), py::arg("rate"), py::arg("inputs"), py::arg("states"),
             "Names of the inputs that are no velocities.");
  module.def("find_alignment", &find, py::arg("X").noconvert(), py::arg("y").noconvert(),
             py::arg("t").noconvert(), py::arg("rate"), py::arg("inputs"), py::arg("states"),
             "Shift [s], names of the commands, their actuators, gain, and why.");
  module.def("align", &align, py::arg("X").noconvert(), py::arg("t").noconvert(), py::arg("rate"),
             py::arg("rows"), py::arg("commands"), py::arg("actuators"),
             "X with commands so many rows later, then through an actuator each, or none.");
}

}  // namespace kelpie::python
