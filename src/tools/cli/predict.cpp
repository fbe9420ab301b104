// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.hpp"
#include "cli/log_options.hpp"
#include "cli/options.hpp"
#include "cli/output.hpp"
#include "cli/tuning.hpp"
#include "format/learned_logs.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/setting.hpp"
#include "kelpie/model/trained_model.hpp"
#include "log/dataset.hpp"
#include "log/row_clock.hpp"
#include "model/snapshot.hpp"
#include "study/alignment.hpp"
#include "study/metrics.hpp"

namespace kelpie::cli {
namespace {

struct PredictArguments {
  log::LogSource source;
  std::string config;
  std::string model;
  std::string out = "predictions.csv";
  std::string time;
  double rate_hz = 0.0;
  std::vector<std::string> units;
  std::vector<std::string> missing;
  std::vector<std::string> pose;
  bool jacobian = false;
  std::string current;
};

// Numbers of the columns that the model sees, in its order.
std::vector<std::size_t> input_columns(const TrainedModel& model, const log::Table& table) {
  std::vector<std::size_t> columns;
  for (const std::string& name : model.input_names) {
    const std::size_t column = table.find(name);
    table.require_numbers(column);
    columns.push_back(column);
  }
  return columns;
}

// A column to be added.
struct NewColumn {
  std::string name;
  std::vector<double> values;  // NaN in rows that aren't seen
};

// The rows with finite inputs, as the model is to see them.
struct SeenRows {
  log::Dataset data;
  std::vector<std::size_t> places;  // in the table
};

// Where neither a column nor the user tells the time, rows come as fast as when the model learned.
SeenRows seen_rows(const TrainedModel& model, const log::Table& table, const log::Roles& roles) {
  std::vector<std::size_t> columns = input_columns(model, table);
  const bool by_time = !model.alignment.none();
  const std::string time = by_time ? log::usual_time(table, roles) : "";
  if (time.empty() && roles.rate_hz == 0.0 && !model.alignment.shifts() &&
      std::ranges::any_of(model.alignment.actuators, &Actuator::takes_time)) {
    throw InputError({.file = table.source, .line = 0, .field = {}},
                     "has no column of time, and the model's actuators take time; name one with "
                     "--time, or give the rows per second with --rate");
  }
  const double rate_hz = roles.rate_hz > 0.0        ? roles.rate_hz
                         : model.alignment.shifts() ? model.alignment.rate_hz()
                                                    : 1.0;
  const std::vector<double> times_s = log::row_times_s(table, time, rate_hz);
  SeenRows seen;
  seen.data.source = table.source;
  seen.data.input_names = model.input_names;
  const Current& water = model.alignment.water;
  if (!water.none()) {  // with the targets of a vehicle at rest: what a current adds
    seen.data.target_names = model.target_names();
    seen.data.heading_column = water.heading;
    columns.push_back(table.find(water.heading));
    table.require_numbers(columns.back());
  }
  const std::size_t inputs = model.input_names.size();
  std::vector<double> x(columns.size());
  for (std::size_t row = 0; row < table.rows(); ++row) {
    std::ranges::transform(columns, x.begin(),
                           [&](std::size_t column) { return table.columns[column][row]; });
    const double t = times_s[row];
    if (std::isfinite(t) && std::ranges::all_of(x, [](double v) { return std::isfinite(v); })) {
      seen.data.inputs.insert(seen.data.inputs.end(), x.begin(),
                              x.begin() + static_cast<std::ptrdiff_t>(inputs));
      if (!water.none()) {
        seen.data.headings.push_back(x.back());
        seen.data.targets.resize(seen.data.targets.size() + model.axes.size());
      }
      seen.data.times_s.push_back(t);
      seen.places.push_back(row);
    }
  }
  const double measured = time.empty() ? rate_hz : log::measured_rate(seen.data.times_s);
  seen.data.rate_hz = measured > 0.0 ? measured : rate_hz;
  seen.data = study::aligned(std::move(seen.data), model.alignment);
  return seen;
}

// Predictions of all targets; then intervals and novelty, where the model knows them; then the
// derivatives, where they are asked for.
std::vector<NewColumn> new_columns(const TrainedModel& model, const SeenRows& seen,
                                   std::size_t rows, bool jacobian) {
  const std::vector<double> none(rows, std::numeric_limits<double>::quiet_NaN());
  const std::size_t axes = model.axes.size();
  const std::size_t inputs = model.input_names.size();
  std::vector<NewColumn> columns;
  std::vector<const double*> values;  // of the row at hand, one per column
  std::vector<Prediction> said(axes);
  std::vector<double> y(axes);
  std::vector<double> slopes(axes * inputs);
  const auto add = [&](std::string name, const double& value) {
    columns.push_back({std::move(name), none});
    values.push_back(&value);
  };
  for (std::size_t i = 0; i < axes; ++i) {
    add(model.axes[i].name + "_predicted", said[i].value);
  }
  for (std::size_t i = 0; i < axes; ++i) {
    if (std::isfinite(model.axes[i].half_width)) {
      add(model.axes[i].name + "_lower", said[i].lower);
      add(model.axes[i].name + "_upper", said[i].upper);
    }
    if (model.axes[i].known) {
      add(model.axes[i].name + "_novelty", said[i].novelty);
    }
  }
  for (std::size_t k = 0; jacobian && k < slopes.size(); ++k) {
    add("d(" + model.axes[k / inputs].name + ")/d(" + model.input_names[k % inputs] + ")",
        slopes[k]);
  }
  for (std::size_t i = 0; i < seen.places.size(); ++i) {
    model.predict(seen.data.input(i), std::span<Prediction>(said));
    for (std::size_t axis = 0; axis < seen.data.target_names.size(); ++axis) {  // over ground
      const double by_current = -seen.data.target(i)[axis];
      said[axis].value += by_current;
      said[axis].lower += by_current;
      said[axis].upper += by_current;
    }
    if (jacobian) {
      model.predict_with_jacobian(seen.data.input(i), y, slopes);
    }
    for (std::size_t column = 0; column < columns.size(); ++column) {
      columns[column].values[seen.places[i]] = *values[column];
    }
  }
  return columns;
}

// The places in the table of the rows that a learner would be shown, and whether each was held out
// when the model learned this log; none, where it isn't known that it did.
struct KnownRows {
  std::vector<std::size_t> places;
  std::vector<bool> held_out;
};

KnownRows known_rows(const TrainedModel& model, const log::Table& table,
                     std::span<const format::LearnedLog> learned) {
  std::vector<std::size_t> columns = input_columns(model, table);
  for (const TrainedModel::Axis& axis : model.axes) {
    const auto found = std::ranges::find(table.names, axis.name);
    if (learned.empty() || found == table.names.end()) {
      return {};
    }
    columns.push_back(static_cast<std::size_t>(found - table.names.begin()));
  }
  KnownRows known;
  log::Dataset data;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto cell = [&](std::size_t column) { return table.columns[column][row]; };
    if (std::ranges::all_of(columns, [&](auto column) { return std::isfinite(cell(column)); })) {
      const auto targets = columns.begin() + static_cast<std::ptrdiff_t>(model.input_names.size());
      std::transform(columns.begin(), targets, std::back_inserter(data.inputs), cell);
      std::transform(targets, columns.end(), std::back_inserter(data.targets), cell);
      data.times_s.push_back(0.0);
      known.places.push_back(row);
    }
  }
  known.held_out = format::held_out_rows(learned, data);
  return known;
}

// How well some rows were predicted.
class Score {
 public:
  void add(double truth, double predicted) {
    if (std::isfinite(truth) && std::isfinite(predicted)) {
      truth_.push_back(truth);
      predicted_.push_back(predicted);
    }
  }
  std::size_t rows() const { return truth_.size(); }
  double r_squared() const { return study::r_squared(truth_, predicted_); }

 private:
  std::vector<double> truth_;
  std::vector<double> predicted_;
};

void print_score(const std::string& name, const std::vector<double>& truth,
                 const std::vector<double>& predicted, const KnownRows& known) {
  if (known.held_out.empty()) {
    Score all;
    for (std::size_t row = 0; row < truth.size(); ++row) {
      all.add(truth[row], predicted[row]);
    }
    say("{}: R² {:.3f} over {} of {} rows\n", name, all.r_squared(), all.rows(), truth.size());
    return;
  }
  std::array<Score, 2> scores;  // learned, held out
  for (std::size_t i = 0; i < known.places.size(); ++i) {
    const std::size_t row = known.places[i];
    scores[known.held_out[i] ? 1 : 0].add(truth[row], predicted[row]);
  }
  if (scores[1].rows() > 0) {
    say("{}: R² {:.3f} over {} rows held out when it learned\n", name, scores[1].r_squared(),
        scores[1].rows());
  }
  say("{}: R² {:.3f} over {} rows that it learned\n", name, scores[0].r_squared(),
      scores[0].rows());
}

// Another vehicle, or another unit: a model knows nothing of what lies far outside of what it saw.
void tell_far_inputs(const TrainedModel& model, const SeenRows& seen, const std::string& source) {
  const std::vector<Extremes>& known = model.axes.front().steady.seen;
  for (std::size_t k = 0; k < known.size(); ++k) {
    const double margin = kTuning.far_margin * (known[k].high - known[k].low);
    std::size_t outside = 0;
    for (std::size_t row = 0; row < seen.data.rows(); ++row) {
      const double value = seen.data.input(row)[k];
      outside += value < known[k].low - margin || value > known[k].high + margin ? 1 : 0;
    }
    if (2 * outside > seen.data.rows()) {
      warn(
          "{}: WARNING: {} is far outside of what the model has seen ({:.3g} to {:.3g}) in {} of "
          "{} rows: another vehicle, or another unit? --units converts\n",
          source, model.input_names[k], known[k].low, known[k].high, outside, seen.data.rows());
    }
  }
}

void predict_log(const PredictArguments& options, TrainedModel& model,
                 const format::ModelInfo& info) {
  const log::LogConfig config = log::read_log_config(options.config);
  log::Roles roles = config.roles;
  roles.inputs = model.input_names;
  if (!options.time.empty() || options.rate_hz != 0.0) {
    roles.time = options.time;
    roles.rate_hz = options.rate_hz;
  }
  add_units(options.units, roles.units);
  roles.pose = options.pose;
  roles.missing = options.missing;
  if (roles.rate_hz != 0.0) {
    require_range("rate", roles.rate_hz, {.low = 0.0, .open = true}, "rows per second");
  }
  log::Log log = open_log(options.source, config, roles);
  log::Table& table = log.table;
  const KnownRows known = known_rows(model, table, info.learned);
  settle_current(options.current, !known.held_out.empty(), options.source.path, model);
  const SeenRows seen = seen_rows(model, table, log.roles);
  tell_other_units(model, info.units, log::column_units(table, log.roles), options.source.path);
  tell_far_inputs(model, seen, options.source.path);
  const std::vector<NewColumn> columns = new_columns(model, seen, table.rows(), options.jacobian);
  for (const NewColumn& column : columns) {
    if (std::ranges::find(table.names, column.name) != table.names.end()) {
      throw InputError({.file = options.source.path, .line = 1, .field = column.name},
                       "is there already; rename it, so that predictions don't mix");
    }
    table.names.push_back(column.name);
    table.columns.push_back(column.values);
  }
  log::write_csv(options.out, table);
  if (!model.alignment.none()) {
    say("{} at {:.4g} rows per second, as when the model was learned\n",
        model.alignment.text(seen.data.rate_hz), seen.data.rate_hz);
  }
  for (std::size_t axis = 0; axis < model.axes.size(); ++axis) {
    const auto found = std::ranges::find(table.names, model.axes[axis].name);
    if (found != table.names.end()) {
      const auto column = static_cast<std::size_t>(found - table.names.begin());
      print_score(model.axes[axis].name, table.columns[column], columns[axis].values, known);
    }
  }
  say("predictions: {}\n", options.out);
}

void predict(const PredictArguments& options) {
  check_output("--out", options.out, {options.source.path, options.model, options.config});
  with_given_model(options.model, [&](TrainedModel& model, const format::ModelInfo& info) {
    predict_log(options, model, info);
  });
}

}  // namespace

void add_predict(CLI::App& app) {
  const auto [command, options] =
      add_command(app, "predict", "Predict the rows of a log with a learned model", predict);
  add_bag_options(*command, options->source, "log", "the log: " + log_formats());
  add_clock_options(*command, options->time, options->rate_hz);
  add_units_option(*command, options->units);
  add_missing_option(*command, options->missing);
  add_pose_option(*command, options->pose);
  add_file(command, "--config", options->config, "TOML file that says what signals to take");
  add_model(command, "--model", options->model);
  command->add_option("--out", options->out, "CSV file: the log's columns and the predictions")
      ->capture_default_str()
      ->type_name("FILE");
  add_known_current_option(*command, options->current);
  command->add_flag("--jacobian", options->jacobian,
                    "also the derivatives of every prediction, as columns d(udot)/d(u)");
  add_examples(command, "predict dive2.csv",
               "predict dive2.csv --model out/tail/model.json --out dive2_predicted.csv");
}

}  // namespace kelpie::cli
