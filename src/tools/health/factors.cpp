// SPDX-License-Identifier: Apache-2.0
#include "health/factors.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "core/eigen.hpp"
#include "core/normal_equations.hpp"
#include "core/seconds.hpp"
#include "health/tuning.hpp"
#include "kelpie/core/error.hpp"
#include "motion/free_fit.hpp"
#include "motion/motion_terms.hpp"
#include "motion/states.hpp"
#include "motion/weak_form.hpp"

namespace kelpie::health {
namespace {

constexpr double kSecondsPerDay = 86400.0;
constexpr double kSecondsPerHour = 3600.0;

// Inputs of the equation: all but the slow columns.
struct Inputs {
  std::vector<std::size_t> places;
  std::vector<std::string> names;
  std::vector<std::size_t> velocities;  // among `places`
  MotionTerms terms;
};

Inputs inputs_of(const log::Dataset& data, const DriveColumns& columns) {
  Inputs inputs{.places = {}, .names = {}, .velocities = {}, .terms = MotionTerms(0, {})};
  std::vector<std::size_t> place_of(data.input_names.size());
  for (std::size_t i = 0; i < data.input_names.size(); ++i) {
    const std::string& name = data.input_names[i];
    if (name != columns.volts && name != columns.density && name != columns.depth) {
      place_of[i] = inputs.places.size();
      inputs.places.push_back(i);
      inputs.names.push_back(name);
    }
  }
  for (const std::size_t velocity : columns.velocities) {
    inputs.velocities.push_back(place_of[velocity]);
  }
  inputs.terms = MotionTerms::open_loop(inputs.names.size(), inputs.velocities, kTuning.most_terms,
                                        attitude_for("auto", inputs.names));
  return inputs;
}

// Windows of an episode, and what is slow in each: the mean of voltage and density.
struct EpisodeRows {
  Episode episode;
  WeakRows weak;  // terms and a constant
  Eigen::VectorXd volts;
  Eigen::VectorXd density;
};

double slow_value(const log::Dataset& data, const std::string& name, std::size_t row) {
  const auto found = std::ranges::find(data.input_names, name);
  return name.empty() ? 1.0
                      : data.input(row)[static_cast<std::size_t>(found - data.input_names.begin())];
}

EpisodeRows episode_rows(const DriveLog& log, const Inputs& inputs, const DriveColumns& columns,
                         std::size_t begin, std::size_t end) {
  const log::Dataset& data = log.data;
  const auto count = static_cast<Eigen::Index>(end - begin);
  const auto terms = static_cast<Eigen::Index>(inputs.terms.size());
  const std::span<const double> times = std::span(data.times_s).subspan(begin, end - begin);
  std::vector<std::size_t> starts;
  const double longest_s = kLongestStep / data.rate_hz;
  Eigen::MatrixXd velocities(count, static_cast<Eigen::Index>(inputs.velocities.size()));
  Eigen::MatrixXd values(count, terms + 3);  // a constant, voltage, density
  std::vector<double> x(inputs.places.size());
  std::vector<double> phi(inputs.terms.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (i == 0 || times[i] - times[i - 1] > longest_s) {
      starts.push_back(i);
    }
    for (std::size_t k = 0; k < x.size(); ++k) {
      x[k] = data.input(begin + i)[inputs.places[k]];
    }
    inputs.terms.evaluate(x, phi);
    const auto row = static_cast<Eigen::Index>(i);
    values.row(row).head(terms) = as_vector(phi).transpose();
    values.row(row).tail(3) << 1.0, slow_value(data, columns.volts, begin + i),
        slow_value(data, columns.density, begin + i);
    for (std::size_t k = 0; k < inputs.velocities.size(); ++k) {
      velocities(row, static_cast<Eigen::Index>(k)) = x[inputs.velocities[k]];
    }
  }
  EpisodeRows rows;
  rows.weak =
      weak_rows({.times_s = times, .starts = starts, .velocities = velocities, .terms = values},
                kPlanarWindow);
  rows.volts = rows.weak.terms.col(terms + 1);
  rows.density = rows.weak.terms.col(terms + 2);
  rows.weak.terms.conservativeResize(Eigen::NoChange, terms + 1);
  rows.episode = {.mission = log.mission,
                  .name = log.mission,
                  .day = log.day + 0.5 * (times.front() + times.back()) / kSecondsPerDay,
                  .hours = (times.back() - times.front()) / kSecondsPerHour};
  return rows;
}

std::vector<EpisodeRows> all_rows(const std::vector<DriveLog>& logs, const Inputs& inputs,
                                  const DriveColumns& columns) {
  std::vector<EpisodeRows> episodes;
  for (const DriveLog& log : logs) {
    std::vector<std::pair<std::size_t, std::size_t>> parts{{0, log.data.rows()}};
    if (!columns.depth.empty()) {
      std::vector<double> depths;
      for (std::size_t row = 0; row < log.data.rows(); ++row) {
        depths.push_back(slow_value(log.data, columns.depth, row));
      }
      parts = find_dives(depths);
    }
    for (std::size_t i = 0; i < parts.size(); ++i) {
      EpisodeRows rows = episode_rows(log, inputs, columns, parts[i].first, parts[i].second);
      if (rows.weak.terms.rows() < 2 * kTuning.pieces) {
        continue;  // too short to tell errors
      }
      if (parts.size() > 1) {
        rows.episode.name += fmt::format(", dive {}", i + 1);
      }
      episodes.push_back(std::move(rows));
    }
  }
  return episodes;
}

// A group of terms that grows and shrinks as one.
struct Group {
  Quantity quantity;
  std::vector<std::pair<Eigen::Index, Eigen::Index>> members{};  // term, axis
  bool is_constant = false;  // of an axis, whose size is wanted, not a factor
};

constexpr std::array<const char*, 6> kAxisNames{"surge", "sway", "heave", "roll", "pitch", "yaw"};

std::string axis_name(const std::string& column) {
  const std::optional<std::size_t> axis = velocity_axis(column);
  return axis ? kAxisNames.at(*axis) : column;
}

bool turns(const std::string& column) {
  return velocity_axis(column).value_or(0) > 2;
}

std::vector<Group> groups_of(const Inputs& inputs) {
  std::vector<Group> groups;
  const auto axes = static_cast<Eigen::Index>(inputs.velocities.size());
  const auto terms = static_cast<Eigen::Index>(inputs.terms.size());
  for (Eigen::Index axis = 0; axis < axes; ++axis) {
    const std::size_t velocity = inputs.velocities[static_cast<std::size_t>(axis)];
    Group drag{.quantity = {axis_name(inputs.names[velocity]) + " drag", ""}};
    for (Eigen::Index term = 0; term < terms; ++term) {
      if (inputs.terms[static_cast<std::size_t>(term)].damps(velocity)) {
        drag.members.emplace_back(term, axis);
      }
    }
    groups.push_back(std::move(drag));
  }
  for (const std::size_t command : inputs.terms.commands()) {
    Group gain{.quantity = {inputs.names[command] + " gain", ""}};
    for (Eigen::Index term = 0; term < terms; ++term) {
      const MotionTerm& one = inputs.terms[static_cast<std::size_t>(term)];
      for (Eigen::Index axis = 0; one.form != TermForm::one && one.a == command && axis < axes;
           ++axis) {
        gain.members.emplace_back(term, axis);
      }
    }
    groups.push_back(std::move(gain));
  }
  for (Eigen::Index axis = 0; axis < axes; ++axis) {
    const std::string& column = inputs.names[inputs.velocities[static_cast<std::size_t>(axis)]];
    groups.push_back({.quantity = {axis_name(column) + (turns(column) ? " trim" : " force"),
                                   turns(column) ? "rad/s²" : "m/s²"},
                      .members = {{terms, axis}},
                      .is_constant = true});
  }
  return groups;
}

// The windows of all episodes, evenly thinned to at most kTuning.most_windows.
WeakRows pooled(const std::vector<EpisodeRows>& episodes) {
  Eigen::Index all = 0;
  for (const EpisodeRows& one : episodes) {
    all += one.weak.terms.rows();
  }
  const Eigen::Index every = 1 + (all - 1) / kTuning.most_windows;
  const Eigen::Index count = (all + every - 1) / every;
  WeakRows rows{Eigen::MatrixXd(count, episodes.front().weak.acceleration.cols()),
                Eigen::MatrixXd(count, episodes.front().weak.terms.cols()),
                {}};
  Eigen::Index seen = 0;
  for (const EpisodeRows& one : episodes) {
    for (Eigen::Index row = 0; row < one.weak.terms.rows(); ++row, ++seen) {
      if (seen % every == 0) {
        rows.acceleration.row(seen / every) = one.weak.acceleration.row(row);
        rows.terms.row(seen / every) = one.weak.terms.row(row);
      }
    }
  }
  return rows;
}

// Terms of commands times (volts / reference)^exponent.
void apply_volts(std::vector<EpisodeRows>& episodes, const Inputs& inputs, double reference,
                 double exponent) {
  for (EpisodeRows& one : episodes) {
    const Eigen::ArrayXd factor = (one.volts.array().max(1e-3) / reference).pow(exponent);
    for (std::size_t term = 0; term < inputs.terms.size(); ++term) {
      if (std::ranges::find(inputs.terms.commands(), inputs.terms[term].a) !=
          inputs.terms.commands().end()) {
        one.weak.terms.col(static_cast<Eigen::Index>(term)).array() *= factor;
      }
    }
  }
}

// The exponent with the least errors of the common fit.
double find_exponent(const std::vector<EpisodeRows>& episodes, const Inputs& inputs,
                     double reference) {
  double best = 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (double exponent = 0.0; exponent <= kTuning.most_exponent;
       exponent += kTuning.exponent_step) {
    std::vector<EpisodeRows> tried = episodes;
    apply_volts(tried, inputs, reference, exponent);
    const double errors =
        fit_freely(pooled(tried), kTuning.pieces).noise.diagonal().array().log().sum();
    if (errors < least) {
      least = errors;
      best = exponent;
    }
  }
  return best;
}

std::pair<double, double> range_of(const std::vector<EpisodeRows>& episodes,
                                   Eigen::VectorXd EpisodeRows::*of) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const EpisodeRows& one : episodes) {
    low = std::min(low, (one.*of).minCoeff());
    high = std::max(high, (one.*of).maxCoeff());
  }
  return {low, high};
}

void take_off_slow(std::vector<EpisodeRows>& episodes, const Inputs& inputs,
                   const DriveColumns& columns, HealthTable& table) {
  if (!columns.density.empty()) {
    const auto [low, high] = range_of(episodes, &EpisodeRows::density);
    for (EpisodeRows& one : episodes) {
      const auto terms = static_cast<Eigen::Index>(inputs.terms.size());
      const Eigen::VectorXd factor = one.density * (2.0 / (low + high));
      one.weak.terms.leftCols(terms) = factor.asDiagonal() * one.weak.terms.leftCols(terms);
    }
    table.remarks.push_back(
        fmt::format("drag and gains are for {:.1f} kg/m³; the water had {:.1f} to {:.1f}",
                    0.5 * (low + high), low, high));
  }
  if (!columns.volts.empty()) {
    const auto [low, high] = range_of(episodes, &EpisodeRows::volts);
    const double reference = 0.5 * (low + high);
    if (!(low > 0.0) || high / low < kTuning.least_volts_ratio) {
      table.remarks.push_back(
          fmt::format("the supply ({:.2f} to {:.2f} V) varies too little to be told from the gains",
                      low, high));
      return;
    }
    const double exponent = find_exponent(episodes, inputs, reference);
    apply_volts(episodes, inputs, reference, exponent);
    table.remarks.push_back(
        fmt::format("gains are for {:.2f} V and go with the power {:.2f} of the supply "
                    "({:.2f} to {:.2f} V)",
                    reference, exponent, low, high));
  }
}

// The factors of one episode: the axes of a window below each other, each over its usual error.
std::vector<Estimate> factors_of(const WeakRows& rows, const FreeFit& common,
                                 const std::vector<Group>& groups) {
  const Eigen::Index axes = rows.acceleration.cols();
  const auto count = static_cast<Eigen::Index>(groups.size());
  Eigen::MatrixXd held = common.coefficients;
  WeakRows stacked{Eigen::MatrixXd::Zero(rows.terms.rows() * axes, 1),
                   Eigen::MatrixXd::Zero(rows.terms.rows() * axes, count),
                   {}};
  const Eigen::VectorXd usual = common.noise.diagonal().cwiseSqrt();
  for (Eigen::Index g = 0; g < count; ++g) {
    const Group& group = groups[static_cast<std::size_t>(g)];
    for (const auto& [term, axis] : group.members) {
      const double weight =
          (group.is_constant ? 1.0 : common.coefficients(term, axis)) / usual(axis);
      stacked.terms(Eigen::seqN(axis, rows.terms.rows(), axes), g) += weight * rows.terms.col(term);
      held(term, axis) = 0.0;
    }
  }
  const Eigen::MatrixXd rest = rows.acceleration - rows.terms * held;
  for (Eigen::Index axis = 0; axis < axes; ++axis) {
    stacked.acceleration(Eigen::seqN(axis, rows.terms.rows(), axes), 0) =
        rest.col(axis) / usual(axis);
  }
  const FreeFit fit = fit_freely(stacked, kTuning.pieces);
  const Eigen::MatrixXd inverse = equilibrated_inverse(fit.gram);
  const Eigen::MatrixXd covariance = inverse * fit.scores * inverse;
  std::vector<Estimate> estimates;
  for (Eigen::Index g = 0; g < count; ++g) {
    const double error = kTuning.student * std::sqrt(covariance(g, g));
    const bool is_told =
        std::isfinite(error) && error > 0.0 && fit.gram(g, g) > 0.0 &&
        (groups[static_cast<std::size_t>(g)].is_constant || error < kTuning.most_error);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    estimates.push_back(is_told ? Estimate{fit.coefficients(g, 0), error} : Estimate{nan, nan});
  }
  return estimates;
}

}  // namespace

HealthTable judge_drives(const std::vector<DriveLog>& logs, const DriveColumns& columns) {
  const Inputs inputs = inputs_of(logs.front().data, columns);
  std::vector<EpisodeRows> episodes = all_rows(logs, inputs, columns);
  Eigen::Index windows = 0;
  for (const EpisodeRows& one : episodes) {
    windows += one.weak.terms.rows();
  }
  const auto needed = static_cast<Eigen::Index>(5 * (inputs.terms.size() + 1));
  if (windows < needed) {
    throw InputError(
        {.file = logs.front().data.source, .line = 0, .field = {}},
        fmt::format("too few rows: {} windows of 5 s without a gap in episodes of 24 s "
                    "and more, {} are needed",
                    windows, needed));
  }
  HealthTable table;
  take_off_slow(episodes, inputs, columns, table);
  const FreeFit common = fit_freely(pooled(episodes), kTuning.pieces);
  const std::vector<Group> groups = groups_of(inputs);
  for (const Group& group : groups) {
    table.quantities.push_back(group.quantity);
  }
  for (const EpisodeRows& one : episodes) {
    table.episodes.push_back(one.episode);
    table.estimates.push_back(factors_of(one.weak, common, groups));
  }
  return table;
}

}  // namespace kelpie::health
