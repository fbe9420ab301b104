// SPDX-License-Identifier: Apache-2.0
#include "lab/reckoning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "chart/text_table.hpp"
#include "chart/wording.hpp"
#include "core/quantile.hpp"
#include "file/json.hpp"
#include "lab/navigators.hpp"
#include "study/open_loop_study.hpp"

namespace kelpie::lab {
namespace {

constexpr double kStill = 0.1;          // m, less than which a vehicle hasn't gone anywhere
constexpr double kReturnS = 2.0;        // of velocities after an outage, for the largest step
constexpr double kHeardS = 2.0;         // of velocities after a cut of the log, before an outage
constexpr double kChiSquare90 = 4.605;  // two degrees of freedom

struct Outage {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::size_t length = 0;  // index into the plan's
};

std::vector<Outage> plan_outages(const log::Dataset& data, const study::Split& split,
                                 const ReckoningPlan& plan) {
  const std::vector<std::size_t> states{0, 1, 2};
  std::vector<Outage> outages;
  for (study::Stretch stretch : study::unbroken_stretches(data, split.held_out, states)) {
    stretch.begin = study::row_after(data, stretch, stretch.begin, kHeardS);
    for (std::size_t k = 0; k < plan.outages_s.size(); ++k) {
      const double seconds = plan.outages_s[k];
      for (const std::size_t start :
           study::starts_in(data.times_s, stretch, std::max(0.5 * seconds, 1.0))) {
        const std::size_t end = study::row_after(data, stretch, start, seconds);
        if (end < stretch.end) {
          outages.push_back({start, end, k});
        }
      }
    }
  }
  std::ranges::sort(outages, {}, &Outage::begin);
  return outages;
}

std::vector<NamedNavigator> copies(const std::vector<NamedNavigator>& navigators) {
  std::vector<NamedNavigator> all;
  for (const NamedNavigator& one : navigators) {
    all.push_back({one.name, one.navigator->clone()});
  }
  return all;
}

// Whether a point is within the 90 % ellipse.
bool is_inside(const std::array<double, 4>& p, double x, double y) {
  const double det = p[0] * p[3] - p[1] * p[2];
  return (p[3] * x * x - (p[1] + p[2]) * x * y + p[0] * y * y) / det <= kChiSquare90;
}

// When velocities are measured again, for some seconds of the same drive.
double largest_step(Navigator& navigator, const log::Dataset& data, std::size_t row) {
  double largest = 0.0;
  const double until_s = data.times_s[row] + kReturnS;
  while (++row < data.rows() && data.times_s[row] <= until_s &&
         data.configurations[row] == data.configurations[row - 1]) {
    navigator.update(data.input(row), data.times_s[row]);
    largest = std::max(largest, navigator.step());
  }
  return largest;
}

// One navigator, a copy of which goes through an outage.
void go_through(const Navigator& before, const log::Dataset& data, const Outage& outage,
                bool yaw_rate, OutageScore& score) {
  const std::unique_ptr<Navigator> navigator = before.clone();
  study::Pose truth;
  study::Pose reckoned;
  double distance = 0.0;
  for (std::size_t row = outage.begin; row < outage.end; ++row) {
    const std::span<const double> now = data.input(row);
    const std::span<const double> next = data.input(row + 1);
    const double dt_s = data.times_s[row + 1] - data.times_s[row];
    std::vector<double> x(next.begin(), next.end());
    std::fill_n(x.begin(), yaw_rate ? 2 : 3, std::numeric_limits<double>::quiet_NaN());
    const double u = navigator->velocity(0);
    const double v = navigator->velocity(1);
    const double r = navigator->velocity(2);
    navigator->update(x, data.times_s[row + 1]);
    const auto mean = [&](std::size_t state) { return 0.5 * (now[state] + next[state]); };
    truth.advance(mean(0), mean(1), mean(2), dt_s);
    reckoned.advance(0.5 * (u + navigator->velocity(0)), 0.5 * (v + navigator->velocity(1)),
                     yaw_rate ? mean(2) : 0.5 * (r + navigator->velocity(2)), dt_s);
    distance += std::hypot(mean(0), mean(1)) * dt_s;
  }
  if (distance <= kStill) {
    return;
  }
  const double x = reckoned.x - truth.x;
  const double y = reckoned.y - truth.y;
  score.errors.push_back(std::hypot(x, y) / distance);
  const auto p = navigator->position_covariance();
  const auto q = navigator->velocity_covariance();
  if (p && q) {
    const std::span<const double> end = data.input(outage.end);
    ++score.told;
    score.inside += is_inside(*p, x, y) ? 1 : 0;
    score.velocity_inside +=
        is_inside(*q, end[0] - navigator->velocity(0), end[1] - navigator->velocity(1)) ? 1 : 0;
    score.steps.push_back(largest_step(*navigator, data, outage.end));
  }
}

double error_quantile(const OutageScore& score, double share) {
  std::vector<double> errors = score.errors;
  return errors.empty() ? std::numeric_limits<double>::quiet_NaN() : quantile(errors, share);
}

double inside_share(const OutageScore& score) {
  return score.told == 0 ? std::numeric_limits<double>::quiet_NaN()
                         : static_cast<double>(score.inside) / static_cast<double>(score.told);
}

std::string result_title(const ReckoningResult& result) {
  return fmt::format("{}{}, {} rows held out ({}), yaw rate {}", result.source,
                     result.simulated ? " (simulation)" : "", chart::grouped(result.held_out),
                     result.split, result.yaw_rate ? "measured" : "not measured either");
}

double velocity_inside_share(const OutageScore& score) {
  return score.told == 0
             ? std::numeric_limits<double>::quiet_NaN()
             : static_cast<double>(score.velocity_inside) / static_cast<double>(score.told);
}

double largest_of(const std::vector<double>& steps) {
  return steps.empty() ? std::numeric_limits<double>::quiet_NaN() : std::ranges::max(steps);
}

void add_shares(chart::TextTable& table, const NavigatorScore& navigator, const std::string& name,
                double (*share)(const OutageScore&)) {
  std::vector<std::string>& row = table.rows.emplace_back(1, name + ": " + navigator.name);
  for (const OutageScore& score : navigator.outages) {
    row.push_back(chart::decimal(share(score)));
  }
}

chart::TextTable result_table(const ReckoningResult& result) {
  chart::TextTable table{result_title(result), {"error over distance: median (95 %)"}, {}};
  for (const OutageScore& score : result.scores.front().outages) {
    table.head.push_back(fmt::format("{:g} s", score.seconds));
  }
  std::vector<std::string>& counts = table.rows.emplace_back(1, "outages");
  for (const OutageScore& score : result.scores.front().outages) {
    counts.push_back(chart::grouped(score.errors.size()));
  }
  for (const NavigatorScore& navigator : result.scores) {
    std::vector<std::string>& row = table.rows.emplace_back(1, navigator.name);
    for (const OutageScore& score : navigator.outages) {
      row.push_back(score.errors.empty()
                        ? "–"
                        : fmt::format("{} ({})", chart::decimal(error_quantile(score, 0.5)),
                                      chart::decimal(error_quantile(score, 0.95))));
    }
  }
  for (const NavigatorScore& navigator : result.scores) {
    if (navigator.outages.front().told > 0) {
      add_shares(table, navigator, "within 90 %", inside_share);
      add_shares(table, navigator, "velocity within 90 %", velocity_inside_share);
      add_shares(table, navigator, "largest step on return",
                 [](const OutageScore& score) { return largest_of(score.steps); });
    }
  }
  return table;
}

file::Json outage_json(const OutageScore& score) {
  return {{"seconds", score.seconds},
          {"outages", score.errors.size()},
          {"median", file::number(error_quantile(score, 0.5))},
          {"p95", file::number(error_quantile(score, 0.95))},
          {"inside_90", file::number(inside_share(score))},
          {"velocity_inside_90", file::number(velocity_inside_share(score))},
          {"largest_step", file::number(largest_of(score.steps))},
          {"errors", file::numbers(score.errors)}};
}

file::Json result_json(const ReckoningResult& result) {
  return {{"source", result.source},
          {"simulated", result.simulated},
          {"split", result.split},
          {"held_out_rows", result.held_out},
          {"yaw_rate_measured", result.yaw_rate},
          {"navigators", file::list(result.scores, [](const NavigatorScore& navigator) {
             return file::Json{{"name", navigator.name},
                               {"outages", file::list(navigator.outages, outage_json)}};
           })}};
}

}  // namespace

void ReckoningResult::join(const ReckoningResult& other) {
  held_out += other.held_out;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    for (std::size_t k = 0; k < scores[i].outages.size(); ++k) {
      OutageScore& mine = scores[i].outages[k];
      const OutageScore& theirs = other.scores[i].outages[k];
      mine.errors.insert(mine.errors.end(), theirs.errors.begin(), theirs.errors.end());
      mine.told += theirs.told;
      mine.inside += theirs.inside;
      mine.velocity_inside += theirs.velocity_inside;
      mine.steps.insert(mine.steps.end(), theirs.steps.begin(), theirs.steps.end());
    }
  }
}

ReckoningResult measure_reckoning(const log::Dataset& data, const study::Split& split,
                                  const ReckoningPlan& plan) {
  std::vector<NamedNavigator> navigators = make_navigators(data, split, plan.settings);
  const std::vector<NamedNavigator> fresh = copies(navigators);
  const std::vector<Outage> outages = plan_outages(data, split, plan);
  ReckoningResult result{.source = data.source,
                         .split = split.label,
                         .yaw_rate = plan.yaw_rate,
                         .held_out = split.held_out.size(),
                         .scores = {}};
  for (const NamedNavigator& one : navigators) {
    NavigatorScore& score = result.scores.emplace_back(NavigatorScore{one.name, {}});
    for (const double seconds : plan.outages_s) {
      score.outages.push_back({.seconds = seconds, .errors = {}, .steps = {}});
    }
  }
  auto next = outages.begin();
  for (std::size_t row = 0; row < data.rows() && next != outages.end(); ++row) {
    if (row > 0 && data.configurations[row] != data.configurations[row - 1]) {
      navigators = copies(fresh);  // another drive
    }
    for (const NamedNavigator& one : navigators) {
      one.navigator->update(data.input(row), data.times_s[row]);
    }
    for (; next != outages.end() && next->begin == row; ++next) {
      for (std::size_t i = 0; i < navigators.size(); ++i) {
        go_through(*navigators[i].navigator, data, *next, plan.yaw_rate,
                   result.scores[i].outages[next->length]);
      }
    }
    if (row % 100 == 0 &&
        !plan.keep_going(static_cast<double>(row) / static_cast<double>(data.rows()))) {
      break;
    }
  }
  return result;
}

std::string reckoning_table(const std::vector<ReckoningResult>& results) {
  std::vector<chart::TextTable> tables;
  std::ranges::transform(results, std::back_inserter(tables), result_table);
  return chart::tables_text(tables);
}

std::string reckoning_json(const std::vector<ReckoningResult>& results) {
  const file::Json document = {
      {"format", "kelpie-reckoning"}, {"version", 1}, {"logs", file::list(results, result_json)}};
  return file::json_text(document, 1);
}

}  // namespace kelpie::lab
