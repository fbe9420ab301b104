// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "bag/open_bag.hpp"
#include "bindings.hpp"
#include "kelpie/core/error.hpp"
#include "log/dataset.hpp"
#include "log/plausibility.hpp"
#include "log/pose_check.hpp"
#include "log/read_log.hpp"
#include "motion/states.hpp"
#include "rows.hpp"

namespace kelpie::python {
namespace {

using Names = std::vector<std::string>;

// `values` (rows, columns) of the first columns; without rows, names alone tell.
py::tuple guessed_roles(const Names& columns, const Names& inputs, const Names& targets,
                        const Array& values) {
  log::Table table;
  table.source = "columns";
  table.names = columns;
  table.columns.resize(columns.size());
  const auto width = static_cast<std::size_t>(values.shape(1));
  require(width <= columns.size(), "columns", "two have one name");
  const Rows rows(values, width, "values");
  for (std::size_t row = 0; row < rows.size(); ++row) {
    for (std::size_t k = 0; k < width; ++k) {
      table.columns[k].push_back(rows[row][k]);
    }
  }
  const log::Roles roles = log::guess_roles(table, {.inputs = inputs, .targets = targets});
  return py::make_tuple(roles.inputs, roles.targets, roles.time);
}

// The targets and the clock of rows that are to be learned.
std::vector<std::string> log_mistakes(const Names& inputs, const Names& targets, const Array& x,
                                      const Array& y, const Array& t, bool has_times,
                                      const std::string& states) {
  log::Dataset data;
  data.input_names = inputs;
  data.target_names = targets;
  data.inputs.assign(x.data(), x.data() + x.size());
  data.targets.assign(y.data(), y.data() + y.size());
  data.times_s.assign(t.data(), t.data() + t.size());
  data.configurations.assign(data.times_s.size(), 0);
  data.time_column = has_times ? "t" : "";
  data.rate_hz = log::measured_rate(data.times_s);
  std::vector<std::string> found;
  if (data.rate_hz > 0.0) {
    for (const log::Mistake& mistake : log::all_mistakes(data, states)) {
      found.push_back(mistake.what);
    }
  }
  return found;
}

// What the names tell, as far as they do.
void add_roles(const log::Log& log, py::dict& found) {
  log::Roles roles = log.roles;
  try {
    roles = log::guess_roles(log.table, log.roles);
  } catch (const InputError&) {
    roles.inputs.clear();
    roles.targets.clear();
  }
  found["inputs"] = roles.inputs;
  found["targets"] = roles.targets;
  found["time"] = roles.time;
}

std::map<std::string, std::string> units_of(const log::Log& log) {
  std::map<std::string, std::string> units = log.roles.units;
  units.insert(log.units.begin(), log.units.end());
  for (std::size_t k = 0; k < log.table.units.size(); ++k) {
    if (!log.table.units[k].empty()) {
      units.emplace(log.table.names[k], log.table.units[k]);
    }
  }
  return units;
}

py::dict dict_of(const log::Log& log) {
  py::dict columns;
  py::dict words;
  for (std::size_t k = 0; k < log.table.names.size(); ++k) {
    const std::vector<double>& values = log.table.columns[k];
    const py::str name(log.table.names[k]);
    columns[name] = Array(extent(values.size()), values.data());
    if (log.table.has_text(k)) {
      words[name] = log.table.texts[k].words;
    }
  }
  py::dict found;
  found["columns"] = columns;
  found["words"] = words;
  found["units"] = units_of(log);
  found["losses"] = log.losses;
  Names doubts;
  std::ranges::transform(log.doubts, std::back_inserter(doubts), log::mistake_text);
  found["doubts"] = doubts;
  found["draft"] = log.draft ? log.draft->toml() : "";
  add_roles(log, found);
  return found;
}

py::dict read_log(const std::string& file, const std::string& config, const Names& columns,
                  bool header_clock, const std::string& messages, bool recover, bool strict,
                  const log::Roles& roles) {
  const bag::ReadMode mode = strict    ? bag::ReadMode::strict
                             : recover ? bag::ReadMode::recover
                                       : bag::ReadMode::usual;
  log::Log log;
  {
    const py::gil_scoped_release release;
    const log::LogSource source{.path = file, .definitions = messages, .mode = mode};
    if (!columns.empty()) {
      log = log::read_columns(source, columns,
                              header_clock ? bag::Clock::header : bag::Clock::receive);
    } else if (!roles.pose.empty()) {
      log = log::read_log(source, {}, roles);
    } else if (config.empty() && !bag::is_bag(file)) {
      // All of it, whether it can be learned or not.
      log.table = log::read_table(source, {}, log.losses);
      log.doubts = log::check_pose(log.table, {}).mistakes;
    } else {
      const log::LogConfig how = log::read_log_config(config);
      log = log::read_log(source, how, how.roles);
    }
  }
  return dict_of(log);
}

}  // namespace

void bind_log(py::module_& module) {
  module.def(
      "guess_roles", &guessed_roles, py::arg("columns"), py::arg("inputs"), py::arg("targets"),
      py::arg("values").noconvert(),
      "Names of inputs and targets, and of the time or \"\"; by values, too, where there are "
      "rows of the first columns.");
  module.def(
      "differentiated",
      [](const std::string& name) {
        const std::vector<std::string_view> found = kelpie::differentiated(name);
        return Names(found.begin(), found.end());
      },
      py::arg("name"), "The names that a velocity may have whose derivative is called so.");
  module.def("log_mistakes", &log_mistakes, py::arg("inputs"), py::arg("targets"), py::arg("x"),
             py::arg("y"), py::arg("t"), py::arg("has_times"), py::arg("states"),
             "What cannot be right in these rows, in words (log/plausibility.hpp).");
  module.def(
      "read_log",
      [](const std::string& file, const std::string& config, const Names& columns,
         bool header_clock, const std::string& messages, bool recover, bool strict,
         const Names& pose, const Names& inputs, double rate_hz) {
        const log::Roles roles{.inputs = inputs, .rate_hz = rate_hz, .pose = pose};
        return read_log(file, config, columns, header_clock, messages, recover, strict, roles);
      },
      py::arg("file"), py::arg("config"), py::arg("columns"), py::arg("header_clock"),
      py::arg("messages"), py::arg("recover"), py::arg("strict"), py::arg("pose"),
      py::arg("inputs"), py::arg("rate"),
      "A log as a dict: columns and words by name, units, inputs, targets, time, losses.");
}

}  // namespace kelpie::python
