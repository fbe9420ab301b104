// SPDX-License-Identifier: Apache-2.0
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <yaml-cpp/yaml.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "bindings.hpp"
#include "cli/output.hpp"
#include "cli/run_program.hpp"
#include "log/dataset.hpp"
#include "study/split.hpp"
#include "turns.hpp"

namespace kelpie::python {
namespace {

namespace py = pybind11;

// One at a time: commands print, and handle signals, for the whole process.
std::string run_command(const std::vector<std::string>& words) {
  static Turns turns;
  const WritingTurn turn(turns);
  const cli::TextStream said;
  const cli::StreamGuard guard({.out = said.file(), .err = said.file()});
  cli::run_command({cli::add_learn, cli::add_compare, cli::add_tune, cli::add_identify}, words);
  return said.text();
}

py::object scalar_of(const YAML::Node& node) {
  constexpr std::string_view kQuoted = "!";
  if (node.Tag() != kQuoted) {
    std::int64_t whole = 0;
    double number = 0.0;
    if (YAML::convert<std::int64_t>::decode(node, whole)) {
      return py::int_(whole);
    }
    if (YAML::convert<double>::decode(node, number)) {
      return py::float_(number);
    }
  }
  return py::str(node.Scalar());
}

// NOLINTNEXTLINE(misc-no-recursion): as deep as the files of kelpie
py::object object_of(const YAML::Node& node) {
  if (node.IsMap()) {
    py::dict map;
    for (const auto& entry : node) {
      map[py::str(entry.first.Scalar())] = object_of(entry.second);
    }
    return map;
  }
  if (node.IsSequence()) {
    py::list list;
    for (const YAML::Node& entry : node) {
      list.append(object_of(entry));
    }
    return list;
  }
  return node.IsNull() ? py::none() : scalar_of(node);
}

py::object parse_yaml(const std::string& text) {
  return object_of(YAML::Load(text));
}

using Numbers = py::array_t<std::size_t>;

py::tuple split_rows(const std::vector<int>& configurations, const std::string& kind,
                     std::size_t block_rows, std::size_t every) {
  log::Dataset data;
  data.times_s.resize(configurations.size());
  data.configurations = configurations;
  study::SplitSettings settings = study::parse_split(kind, 1);
  settings.block_rows = block_rows;
  settings.every = every;
  const study::Split split = study::make_split(data, settings);
  return py::make_tuple(
      Numbers(static_cast<py::ssize_t>(split.training.size()), split.training.data()),
      Numbers(static_cast<py::ssize_t>(split.held_out.size()), split.held_out.data()));
}

}  // namespace

void bind_studies(py::module_& module) {
  module.def("run_command", &run_command, py::arg("words"),
             "Runs `kelpie learn`, `compare`, `tune` or `identify` in this process: what it says.");
  module.def("parse_yaml", &parse_yaml, py::arg("text"), "A file of kelpie as dicts and lists.");
  module.def("split_rows", &split_rows, py::arg("configurations"), py::arg("kind"),
             py::arg("block_rows"), py::arg("every"), "Training and held-out rows.");
}

}  // namespace kelpie::python
