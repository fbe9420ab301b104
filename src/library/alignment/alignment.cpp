// SPDX-License-Identifier: Apache-2.0
#include "kelpie/alignment/alignment.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <utility>

#include "alignment/alignment_fit.hpp"
#include "alignment/alignment_search.hpp"
#include "alignment/tuning.hpp"
#include "core/seconds.hpp"
#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/motion/attitude.hpp"
#include "motion/states.hpp"

namespace kelpie {
namespace {

constexpr const auto& kAlignment = kAlignmentTuning.alignment;

// In two digits, since the search changes a lag by a fifth at least.
double two_digits(double lag_s) {
  if (lag_s == 0.0) {
    return 0.0;
  }
  const double unit = std::pow(10.0, std::floor(std::log10(lag_s)) - 1.0);
  return std::round(lag_s / unit) * unit;
}

// Of one actuator, or of several alike.
std::string properties(const Actuator& actuator, bool several) {
  const std::string s = several ? " " : "s ";
  std::string text;
  const auto add = [&](bool is_there, const std::string& part) {
    text += is_there ? (text.empty() ? "" : ", ") + part : "";
  };
  add(actuator.neutral != 0.0, "rest" + s + "at " + short_number(actuator.neutral));
  add(actuator.dead_band > 0.0, (several ? "have no effect within " : "has no effect within ") +
                                    short_number(actuator.dead_band) + " of rest");
  add(actuator.astern != 1.0, "give" + s + short_number(actuator.astern) + " times as much astern");
  add(actuator.lag_s > 0.0, (several ? "follow their commands in " : "follows its command in ") +
                                short_number(two_digits(actuator.lag_s)) + " s");
  add(actuator.rate > 0.0,
      "change" + s + "by at most " + short_number(actuator.rate) + " per second");
  add(actuator.delay_s > 0.0, "begin" + s + short_number(actuator.delay_s) + " s late");
  return text.empty() ? "act" + s + "at once" : text;
}

double correlation_between(const Eigen::ArrayXd& a, const Eigen::ArrayXd& b) {
  const Eigen::ArrayXd da = a - a.mean();
  const Eigen::ArrayXd db = b - b.mean();
  const double both = std::sqrt(da.square().sum() * db.square().sum());
  return both > 0.0 ? (da * db).sum() / both : 0.0;
}

// For each target the input whose slope over half a second goes with it best. None unless every
// target has one of its own.
std::vector<std::size_t> accelerated_inputs(const AlignmentProblem& problem,
                                            const AlignmentRows& rows) {
  const int reach = std::max(1, static_cast<int>(std::lround(0.25 * problem.rate_hz)));
  const auto size = static_cast<Eigen::Index>(rows.size());
  std::vector<std::size_t> best(rows.targets.size());
  std::vector<double> most(rows.targets.size(), kAlignment.slope_correlation);
  Eigen::ArrayXd rise(size);
  for (std::size_t i = 0; i < rows.inputs.size(); ++i) {
    for (Eigen::Index at = 0; at < size; ++at) {
      const auto row = static_cast<std::size_t>(at);
      rise[at] =
          rows.inputs[i][rows.shifted(row, reach)] - rows.inputs[i][rows.shifted(row, -reach)];
    }
    for (std::size_t target = 0; target < best.size(); ++target) {
      const double found = correlation_between(
          rise, Eigen::Map<const Eigen::ArrayXd>(rows.targets[target].data(), size));
      if (found > most[target]) {
        most[target] = found;
        best[target] = i;
      }
    }
  }
  std::ranges::sort(best);
  const bool all =
      std::ranges::none_of(most, [](double c) { return c == kAlignment.slope_correlation; }) &&
      std::ranges::adjacent_find(best) == best.end();
  return all ? best : std::vector<std::size_t>{};
}

// All inputs but the velocities and the attitude; none where there are no velocities.
std::vector<std::size_t> all_but(std::span<const std::size_t> velocities,
                                 std::span<const std::string> inputs) {
  std::vector<std::size_t> commands;
  const Attitude attitude = find_attitude(inputs);
  for (std::size_t i = 0; i < inputs.size() && !velocities.empty(); ++i) {
    if (std::ranges::find(velocities, i) == velocities.end() && !attitude.contains(i)) {
      commands.push_back(i);
    }
  }
  return commands;
}

std::vector<std::size_t> velocities_by_name(std::span<const std::string> inputs,
                                            std::size_t targets, const std::string& states) {
  std::vector<std::size_t> velocities = find_states(states, inputs, targets);
  if (velocities.empty()) {
    velocities.resize(named_velocities(inputs));
    std::iota(velocities.begin(), velocities.end(), std::size_t{0});
  }
  return velocities;
}

std::vector<std::size_t> commands_of(const AlignmentProblem& problem, const AlignmentRows& rows) {
  std::vector<std::size_t> velocities =
      velocities_by_name(problem.input_names, problem.target_count, problem.states);
  if (velocities.empty()) {
    velocities = accelerated_inputs(problem, rows);
  }
  return all_but(velocities, problem.input_names);
}

struct Searched {
  AlignmentResult found;
  std::vector<std::size_t> explained;  // rows in use that the alignment found explains
};

Searched search(const AlignmentProblem& problem) {
  Searched searched{.found = {.alignment = problem.current, .gain = 0.0, .why = {}},
                    .explained{problem.rows.begin(), problem.rows.end()}};
  AlignmentResult& found = searched.found;
  const AlignmentRows rows(problem);
  const std::vector<std::size_t> commands = commands_of(problem, rows);
  found.alignment.commands.clear();
  for (const std::size_t command : commands) {
    found.alignment.commands.push_back(problem.input_names[command]);
  }
  const Alignment known = found.alignment.with(problem.known);
  if (found.alignment.none()) {
    found.alignment = known;
  }
  if (commands.empty()) {
    found.why = "no inputs are known to be velocities and others commands";
    return searched;
  }
  AlignmentFit fit(rows, commands);
  const std::size_t needed = kAlignment.rows_per_coefficient * fit.terms();
  if (rows.size() < needed) {
    found.why = std::to_string(rows.size()) + " training rows are too few to tell a shift; " +
                std::to_string(needed) + " are needed";
  } else if (problem.rate_hz * kAlignment.farthest_s < 1.0) {
    found.why = "rows are too far apart in time to tell a shift";
  } else {
    AlignmentSearch(fit, problem.rate_hz, known).improve(found);
    std::vector<std::size_t> explained =
        fit.explained_rows(AlignmentGuess::of(found.alignment, fit.commands().size()));
    if (explained.size() >= needed) {
      searched.explained = std::move(explained);
    }
  }
  return searched;
}

int within_bounds(int rows) {
  require(rows >= -AlignedRows::kMostRows && rows <= AlignedRows::kMostRows, "rows",
          "have to be within ±" + std::to_string(AlignedRows::kMostRows));
  return rows;
}

}  // namespace

int Alignment::rows_at(double rate_hz) const {
  return static_cast<int>(std::lround(
      std::clamp(lag_s * rate_hz, -kAlignment.most_rows_away, kAlignment.most_rows_away)));
}

Alignment Alignment::by(double lag_s, std::span<const std::string> inputs,
                        std::span<const std::size_t> commands, double rate_hz) {
  Alignment alignment{.lag_s = lag_s};
  for (const std::size_t command : commands) {
    alignment.commands.push_back(inputs[command]);
  }
  return alignment.at(rate_hz);
}

double Alignment::command_for(std::string_view input, double effect) const {
  const auto found = std::ranges::find(commands, input);
  const auto place = static_cast<std::size_t>(found - commands.begin());
  return place < actuators.size() ? actuators[place].command_for(effect) : effect;
}

Alignment Alignment::with(const std::map<std::string, Actuator>& known) const {
  Alignment alignment = *this;
  alignment.actuators.assign(known.empty() ? 0 : commands.size(), {});
  for (const auto& [name, actuator] : known) {
    const auto found = std::ranges::find(commands, name);
    require(
        found != commands.end(), name,
        "is to have an actuator, but isn't known to be a command; name the velocities by states");
    alignment.actuators[static_cast<std::size_t>(found - commands.begin())] = actuator;
  }
  return alignment;
}

std::string Actuator::text() const {
  return properties(*this, false);
}

std::string Alignment::text(double rate_hz) const {
  if (none()) {
    return "commands are taken as they stand";
  }
  std::string text;
  if (shifts()) {
    text = "commands are taken " + short_number(std::abs(lag_s)) + " s ";
    if (rate_hz > 0.0) {
      const int count = std::abs(rows_at(rate_hz));
      text += "(" + std::to_string(count) + (count == 1 ? " row) " : " rows) ");
    }
    text += lag_s > 0.0 ? "later" : "earlier";
  }
  std::vector<bool> told(actuators.size());
  for (std::size_t k = 0; k < actuators.size(); ++k) {
    if (!told[k] && !actuators[k].none()) {
      std::string names;
      std::size_t count = 0;
      for (std::size_t other = k; other < actuators.size(); ++other) {
        if (actuators[other] == actuators[k]) {
          told[other] = true;
          ++count;
          names += (names.empty() ? "" : ", ") + commands[other];
        }
      }
      text += (text.empty() ? "" : "; ") + names + ": " + properties(actuators[k], count > 1);
    }
  }
  if (!water.none()) {
    text += (text.empty() ? "" : "; ") + std::string("velocities are through the water: ") +
            water.text();
  }
  return text;
}

Alignment Alignment::at(double rate_hz) const {
  const int rows_there = rows_at(rate_hz);
  return {rows_there == 0 ? 0.0 : rows_there / rate_hz, rows_there, commands, actuators, water};
}

AlignedRows::AlignedRows(int rows, std::vector<std::size_t> commands, std::size_t inputs,
                         std::size_t targets, double rate_hz, std::span<const Actuator> actuators)
    : shift_(within_bounds(rows)),
      distance_(static_cast<std::size_t>(std::abs(rows))),
      commands_(std::move(commands)),
      inputs_(inputs),
      targets_(targets),
      longest_step_s_(kLongestStep / rate_hz),
      ring_((distance_ + 1) * (inputs + targets + 1)),
      row_(inputs) {
  if (!(rate_hz > 0.0)) {
    throw InputError("rate", "has to be > 0 rows per second");
  }
  if (std::ranges::any_of(commands_, [&](std::size_t place) { return place >= inputs_; })) {
    throw InputError("commands", "have to be among the inputs");
  }
  require(actuators.empty() || actuators.size() == commands_.size(), "actuators",
          "have to be one per command, or none");
  for (const Actuator& actuator : actuators) {
    states_.emplace_back(actuator, rate_hz);
  }
}

void AlignedRows::rest() {
  count_ = 0;
  std::ranges::for_each(states_, &ActuatorState::rest);
}

bool AlignedRows::ends_before(double t) const {
  if (count_ == 0) {
    return false;
  }
  const std::size_t width = inputs_ + targets_ + 1;
  const double step_s = t - ring_[(count_ - 1) % (distance_ + 1) * width + width - 1];
  return step_s < 0.0 || step_s > longest_step_s_;
}

std::span<double> AlignedRows::slot(std::size_t row) {
  const std::size_t width = inputs_ + targets_ + 1;
  return std::span(ring_).subspan(row % (distance_ + 1) * width, width);
}

void AlignedRows::keep(std::span<const double> x, std::span<const double> y, double t) {
  require_size("x", x.size(), inputs_);
  require_size("y", y.size(), targets_);
  const std::span<double> place = slot(count_);
  std::ranges::copy(x, place.begin());
  std::ranges::copy(y, place.begin() + static_cast<std::ptrdiff_t>(inputs_));
  place.back() = t;
  ++count_;
}

std::span<const double> AlignedRows::with_commands(std::span<const double> row,
                                                   std::span<const double> from) {
  std::ranges::copy(row.first(inputs_), row_.begin());
  for (std::size_t k = 0; k < commands_.size(); ++k) {
    const double command = from[commands_[k]];
    row_[commands_[k]] = states_.empty() ? command : states_[k].next(command, row.back());
  }
  return row_;
}

std::vector<std::size_t> named_commands(std::span<const std::string> inputs, std::size_t targets,
                                        const std::string& states) {
  return all_but(velocities_by_name(inputs, targets, states), inputs);
}

std::vector<std::size_t> find_commands(const AlignmentProblem& problem) {
  return commands_of(problem, AlignmentRows(problem));
}

AlignmentResult find_alignment(const AlignmentProblem& problem) {
  const Searched all = search(problem);
  const double left_out =
      1.0 - static_cast<double>(all.explained.size()) / static_cast<double>(problem.rows.size());
  if (left_out < kAlignment.least_left_out || left_out > kAlignment.most_left_out) {
    return all.found;
  }
  AlignmentProblem explained = problem;
  explained.rows = all.explained;
  return search(explained).found;
}

}  // namespace kelpie
