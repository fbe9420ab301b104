// SPDX-License-Identifier: Apache-2.0
#include "kelpie/alignment/alignment.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "alignment/current_fit.hpp"
#include "alignment/fold_evidence.hpp"
#include "alignment/tuning.hpp"
#include "core/angle.hpp"
#include "core/seconds.hpp"
#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "motion/states.hpp"

namespace kelpie {
namespace {

constexpr const auto& kWaterSearch = kAlignmentTuning.water;

constexpr std::size_t kSurge = 0, kSway = 1, kYaw = 5;  // velocity_axis()

std::string hundredths(double value) {
  return short_number(std::round(100.0 * value) / 100.0);
}

// The motion in the plane, by the names of the velocities.
std::optional<PlanarPlaces> find_places(const AlignmentProblem& problem) {
  const std::vector<std::size_t> states =
      find_states(problem.states, problem.input_names, problem.target_count);
  std::array<std::optional<std::size_t>, 6> targets;
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (const auto axis = velocity_axis(problem.input_names[states[i]])) {
      targets[*axis] = i;
    }
  }
  std::optional<std::size_t> yaw_rate;
  for (std::size_t i = problem.input_names.size(); i-- > 0;) {
    yaw_rate = velocity_axis(problem.input_names[i]) == kYaw ? i : yaw_rate;
  }
  if (!targets[kSurge] || !targets[kSway] || !yaw_rate) {
    return std::nullopt;
  }
  return PlanarPlaces{.surge = states[*targets[kSurge]],
                      .sway = states[*targets[kSway]],
                      .yaw_rate = *yaw_rate,
                      .surge_target = *targets[kSurge],
                      .sway_target = *targets[kSway]};
}

// Turns of the vehicle, in the unit of the heading and by the yaw rate [rad], each of a few seconds
// of neighbouring rows in use.
struct Turns {
  std::vector<double> by_heading;
  std::vector<double> by_rate;
};

Turns turns_of(const AlignmentProblem& problem, std::size_t yaw_rate,
               std::span<const double> headings, double full_turn) {
  Turns turns;
  double heading = 0.0;
  double angle = 0.0;
  double since_s = 0.0;
  const std::size_t width = problem.input_names.size();
  for (std::size_t i = 1; i < problem.rows.size(); ++i) {
    const std::size_t row = problem.rows[i];
    const std::size_t before = problem.rows[i - 1];
    const double step_s = problem.times_s[row] - problem.times_s[before];
    const bool breaks = row != before + 1 || step_s > kLongestStep / problem.rate_hz;
    if (!breaks) {
      heading += std::remainder(headings[row] - headings[before], full_turn);
      angle += 0.5 * step_s *
               (problem.inputs[row * width + yaw_rate] + problem.inputs[before * width + yaw_rate]);
      since_s += step_s;
    }
    if (since_s >= kWaterSearch.turn_s) {
      turns.by_heading.push_back(heading);
      turns.by_rate.push_back(angle);
    }
    if (breaks || since_s >= kWaterSearch.turn_s) {
      heading = angle = since_s = 0.0;
    }
  }
  return turns;
}

// Radians per unit of the heading, below 0 where the heading falls with the yaw rate; none where
// the two do not go together.
std::optional<double> unit_of(const AlignmentProblem& problem, std::size_t yaw_rate,
                              std::span<const double> headings) {
  for (const double unit : {1.0, kRadPerDegree}) {
    const Turns turns = turns_of(problem, yaw_rate, headings, kFullTurn / unit);
    double both = 0.0;
    double squares = 0.0;
    for (std::size_t i = 0; i < turns.by_rate.size(); ++i) {
      both += turns.by_heading[i] * unit * turns.by_rate[i];
      squares += turns.by_rate[i] * turns.by_rate[i];
    }
    const double slope = squares > 0.0 ? both / squares : 0.0;
    if (std::sqrt(squares) >= kWaterSearch.least_turn_rad &&
        std::abs(std::abs(slope) - 1.0) <= kWaterSearch.unit_tolerance) {
      return std::copysign(unit, slope);
    }
  }
  return std::nullopt;
}

// Why there can be no search; empty: there can.
std::string reason_against(const AlignmentProblem& problem,
                           const std::optional<PlanarPlaces>& places,
                           std::span<const double> headings) {
  if (!places) {
    return "surge and sway with their accelerations, and the yaw rate, are not known by name";
  }
  const bool complete = std::ranges::all_of(
      problem.rows, [&](std::size_t row) { return std::isfinite(headings[row]); });
  if (!complete) {
    return "the heading is not known in every row";
  }
  const bool is_fast = std::ranges::any_of(problem.rows, [&](std::size_t row) {
    return std::abs(problem.inputs[row * problem.input_names.size() + places->yaw_rate]) >
           kWaterSearch.most_rate;
  });
  return is_fast ? "the yaw rate is not in rad/s" : "";
}

double largest_speed(const AlignmentProblem& problem, const PlanarPlaces& places) {
  double most = 0.0;
  for (const std::size_t row : problem.rows) {
    const std::span<const double> x =
        problem.inputs.subspan(row * problem.input_names.size(), problem.input_names.size());
    most = std::max(most, std::hypot(x[places.surge], x[places.sway]));
  }
  return most;
}

// From one current to the same, told at more times.
Eigen::VectorXd refined(const Eigen::VectorXd& coarse, std::size_t knots) {
  const auto count = static_cast<Eigen::Index>(knots);
  const Eigen::Index known = coarse.size() / 2;
  Eigen::VectorXd fine = Eigen::VectorXd::Zero(2 * count);
  for (Eigen::Index i = 0; i < count && known > 0; ++i) {
    const double at = count == 1 ? 0.0
                                 : static_cast<double>(i) * static_cast<double>(known - 1) /
                                       static_cast<double>(count - 1);
    const auto from = static_cast<Eigen::Index>(at);
    const Eigen::Index to = std::min(from + 1, known - 1);
    const double share = at - static_cast<double>(from);
    fine.segment<2>(2 * i) =
        (1.0 - share) * coarse.segment<2>(2 * from) + share * coarse.segment<2>(2 * to);
  }
  return fine;
}

void take(const CurrentFit& fit, const Eigen::VectorXd& found, Current& current) {
  const auto knots = static_cast<std::size_t>(found.size() / 2);
  current.times_s = fit.knots(knots);
  for (Eigen::Index i = 0; i < found.size(); i += 2) {
    current.velocity.push_back({found[i], found[i + 1]});
  }
}

void search(const AlignmentProblem& problem, const PlanarPlaces& places,
            std::span<const double> headings_rad, CurrentResult& result) {
  const CurrentFit fit(problem, places, headings_rad);
  if (fit.rows() < kAlignmentTuning.alignment.rows_per_coefficient * fit.terms()) {
    result.why = std::to_string(fit.rows()) + " training rows are too few to tell a current";
    return;
  }
  std::vector<Eigen::VectorXd> currents{Eigen::VectorXd()};
  std::vector<Eigen::ArrayXXd> errors{fit.log_errors(currents.front())};
  const double duration_s =
      problem.times_s[problem.rows.back()] - problem.times_s[problem.rows.front()];
  for (std::size_t knots = 1; knots <= kWaterSearch.most_knots;
       knots = knots == 1 ? 3 : 2 * knots - 1) {
    if (knots > 1 && duration_s < kWaterSearch.least_between_s * static_cast<double>(knots - 1)) {
      break;
    }
    currents.push_back(fit.fitted(refined(currents.back(), knots)));
    errors.push_back(fit.log_errors(currents.back()));
  }
  const std::size_t chosen = simplest_of_best(errors);
  const FoldEvidence gain(errors.front() - errors[chosen]);
  const std::string evidence = gain.percent() + " of what is unexplained in still water, on " +
                               std::to_string(CurrentFit::kFolds) + " folds of the training rows";
  if (chosen == 0) {
    result.why = "no current explains more";
  } else if (!gain.is_clear()) {
    result.why = "no current is clearly better; the best explains " + evidence;
  } else {
    take(fit, currents[chosen], result.current);
    result.gain = gain.explained();
    result.why = "this explains " + evidence;
  }
}

}  // namespace

std::array<double, 2> Current::at(double t) const {
  const auto after = std::ranges::upper_bound(times_s, t);
  const auto next = static_cast<std::size_t>(after - times_s.begin());
  if (next == 0 || next == times_s.size()) {
    return next == 0 ? velocity.front() : velocity.back();
  }
  const double share = (t - times_s[next - 1]) / (times_s[next] - times_s[next - 1]);
  const auto between = [&](std::size_t i) {
    return velocity[next - 1][i] + share * (velocity[next][i] - velocity[next - 1][i]);
  };
  return {between(0), between(1)};
}

std::array<double, 2> Current::in_body(double reading, double t) const {
  const auto [first, second] = at(t);
  const double angle = unit * reading;
  return {first * std::cos(angle) + second * std::sin(angle),
          second * std::cos(angle) - first * std::sin(angle)};
}

std::array<double, 2> Current::speeds() const {
  const auto speed = [](const std::array<double, 2>& c) { return std::hypot(c[0], c[1]); };
  const auto [low, high] = std::ranges::minmax(velocity, {}, speed);
  return {speed(low), speed(high)};
}

std::string Current::text() const {
  std::array<double, 2> mean{};
  for (const auto& [first, second] : velocity) {
    mean[0] += first / static_cast<double>(velocity.size());
    mean[1] += second / static_cast<double>(velocity.size());
  }
  const double towards = std::copysign(1.0, unit) * std::atan2(mean[1], mean[0]) / kRadPerDegree;
  const double whole = std::round(towards < 0.0 ? towards + 360.0 : towards);
  const std::string direction = short_number(whole == 360.0 ? 0.0 : whole) + "° of " + heading;
  const std::string size = hundredths(std::hypot(mean[0], mean[1])) + " m/s";
  const auto [low, high] = speeds();
  return velocity.size() == 1 ? "a current of " + size + " towards " + direction
                              : "a current of " + hundredths(low) + " to " + hundredths(high) +
                                    " m/s, on average " + size + " towards " + direction;
}

void Current::validate() const {
  require(velocity.size() == times_s.size(), "velocity", "has to have one entry per time");
  require(std::ranges::all_of(times_s, [](double t) { return std::isfinite(t); }) &&
              std::ranges::adjacent_find(times_s, std::greater_equal<>()) == times_s.end(),
          "times_s", "have to be finite and ascending");
  require(std::ranges::all_of(
              velocity, [](const auto& c) { return std::isfinite(c[0]) && std::isfinite(c[1]); }),
          "velocity", "has to be finite");
  require(std::isfinite(unit) && unit != 0.0, "unit", "has to be a number other than 0");
}

CurrentResult find_current(const AlignmentProblem& problem, const std::string& name,
                           std::span<const double> headings) {
  CurrentResult result;
  const std::optional<PlanarPlaces> places = find_places(problem);
  result.why = reason_against(problem, places, headings);
  if (!result.why.empty()) {
    return result;
  }
  const std::optional<double> unit = unit_of(problem, places->yaw_rate, headings);
  if (!unit) {
    result.why = name + " does not turn as the yaw rate tells";
    return result;
  }
  std::vector<double> headings_rad;
  for (const std::size_t row : problem.rows) {
    headings_rad.push_back(*unit * headings[row]);
  }
  search(problem, *places, headings_rad, result);
  Current& current = result.current;
  if (!current.none() && current.speeds()[1] > largest_speed(problem, *places)) {
    return {.current = {}, .gain = 0.0, .why = "a current faster than the vehicle is no current"};
  }
  if (!current.none()) {
    current.heading = name;
    current.unit = *unit;
    current.surge = problem.input_names[places->surge];
    current.sway = problem.input_names[places->sway];
    current.yaw_rate = problem.input_names[places->yaw_rate];
    current.targets = {places->surge_target, places->sway_target};
  }
  return result;
}

}  // namespace kelpie
