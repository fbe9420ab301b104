// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "commands.hpp"
#include "config_file.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/data/csv.hpp"
#include "kelpie/report/model_json.hpp"
#include "kelpie/study/metrics.hpp"
#include "log_reader.hpp"

namespace kelpie::cli {
namespace {

struct Options {
  BagOptions source;
  std::string config;
  std::string model;
  std::string out = "predictions.csv";
};

// Numbers of the columns that the model sees, in its order.
std::vector<std::size_t> input_columns(const TrainedModel& model, const Table& table) {
  std::vector<std::size_t> columns;
  for (const std::string& name : model.input_names) {
    const std::size_t column = table.find(name);
    table.require_numbers(column);
    columns.push_back(column);
  }
  return columns;
}

// The predictions of one axis after the other; NaN in rows with an input that isn't finite.
std::vector<std::vector<double>> predictions(const TrainedModel& model, const Table& table) {
  const std::vector<std::size_t> columns = input_columns(model, table);
  std::vector<std::vector<double>> predicted(model.axes.size());
  std::vector<double> x(columns.size());
  std::vector<double> y(model.axes.size());
  for (std::size_t row = 0; row < table.rows(); ++row) {
    std::ranges::transform(columns, x.begin(),
                           [&](std::size_t column) { return table.columns[column][row]; });
    if (std::ranges::all_of(x, [](double value) { return std::isfinite(value); })) {
      model.predict(x, y);
    } else {
      std::ranges::fill(y, std::numeric_limits<double>::quiet_NaN());
    }
    for (std::size_t axis = 0; axis < y.size(); ++axis) {
      predicted[axis].push_back(y[axis]);
    }
  }
  return predicted;
}

void print_score(const std::string& name, const std::vector<double>& truth,
                 const std::vector<double>& predicted) {
  std::vector<double> both_true;
  std::vector<double> both_predicted;
  for (std::size_t row = 0; row < truth.size(); ++row) {
    if (std::isfinite(truth[row]) && std::isfinite(predicted[row])) {
      both_true.push_back(truth[row]);
      both_predicted.push_back(predicted[row]);
    }
  }
  fmt::print("{}: R² {:.3f} over {} of {} rows\n", name, r_squared(both_true, both_predicted),
             both_true.size(), truth.size());
}

void predict(const Options& options) {
  const TrainedModel model = read_model(options.model);
  const ConfigFile config = options.config.empty() ? ConfigFile{} : read_config(options.config);
  Log log = read_log(options.source, config, config.roles);
  fmt::print("{}", log.notes);
  Table& table = log.table;
  const std::vector<std::vector<double>> predicted = predictions(model, table);
  for (std::size_t axis = 0; axis < model.axes.size(); ++axis) {
    const std::string& target = model.axes[axis].name;
    const std::string column = target + "_predicted";
    if (std::ranges::find(table.names, column) != table.names.end()) {
      throw InputError({.file = options.source.path, .line = 1, .field = column},
                       "is there already; rename it, so that predictions don't mix");
    }
    table.names.push_back(column);
    table.columns.push_back(predicted[axis]);
  }
  write_csv(options.out, table);
  for (std::size_t axis = 0; axis < model.axes.size(); ++axis) {
    const auto found = std::ranges::find(table.names, model.axes[axis].name);
    if (found != table.names.end()) {
      const auto column = static_cast<std::size_t>(found - table.names.begin());
      print_score(model.axes[axis].name, table.columns[column], predicted[axis]);
    }
  }
  fmt::print("predictions: {}\n", options.out);
}

}  // namespace

void add_predict(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* const command =
      app.add_subcommand("predict", "Predict the rows of a log with a learned model");
  options->source.add_to(*command, "log",
                         "the log: a CSV file with a header, or a ROS 2 bag with --config");
  command->add_option("--config", options->config, "TOML file that says what signals to take");
  command->add_option("--model", options->model, "model.json of `kelpie learn`")->required();
  command->add_option("--out", options->out, "CSV file: the log's columns and the predictions")
      ->capture_default_str();
  command->callback([options] { predict(*options); });
}

}  // namespace kelpie::cli
