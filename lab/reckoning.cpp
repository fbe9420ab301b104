// SPDX-License-Identifier: Apache-2.0
#include "lab/reckoning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

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
constexpr double kFirstS = 300.0;       // of a drive, before outages
constexpr double kRenewedS = 10.0;      // between models, as `kelpie live`
constexpr double kChiSquare90 = 4.605;  // two degrees of freedom

struct Outage {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::size_t length = 0;  // index into the plan's
};

std::vector<Outage> plan_outages(const log::Dataset& data, std::span<const std::size_t> rows,
                                 const ReckoningPlan& plan) {
  const std::vector<std::size_t> states{0, 1, 2};
  std::vector<Outage> outages;
  for (study::Stretch stretch : study::unbroken_stretches(data, rows, states)) {
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

SensedRow sensed(const log::Dataset& data, std::size_t row) {
  return {data.input(row), data.target(row), data.times_s[row]};
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
    navigator.update(sensed(data, row));
    largest = std::max(largest, navigator.step());
  }
  return largest;
}

// The inputs of a row in an outage.
std::vector<double> lost(const log::Dataset& data, const Outage& outage, std::size_t row,
                         OutageKind kind, bool yaw_rate) {
  const std::span<const double> now = data.input(row);
  std::vector<double> x(now.begin(), now.end());
  for (std::size_t i = 0; i < (yaw_rate ? 2U : 3U); ++i) {
    x[i] = kind == OutageKind::silent  ? std::numeric_limits<double>::quiet_NaN()
           : kind == OutageKind::zeros ? 0.0
                                       : data.input(outage.begin)[i];
  }
  return x;
}

// One navigator, a copy of which goes through an outage.
void go_through(const Navigator& before, const log::Dataset& data, const Outage& outage,
                const ReckoningPlan& plan, OutageScore& score) {
  const std::unique_ptr<Navigator> navigator = before.clone();
  const bool disguised = plan.kind != OutageKind::silent && before.believes().has_value();
  double found_s = std::numeric_limits<double>::infinity();
  study::Pose truth;
  study::Pose reckoned;
  double distance = 0.0;
  for (std::size_t row = outage.begin; row < outage.end; ++row) {
    const std::span<const double> now = data.input(row);
    const std::span<const double> next = data.input(row + 1);
    const double dt_s = data.times_s[row + 1] - data.times_s[row];
    const std::vector<double> x =
        lost(data, outage, row + 1, disguised ? plan.kind : OutageKind::silent, plan.yaw_rate);
    const double u = navigator->velocity(0);
    const double v = navigator->velocity(1);
    const double r = navigator->velocity(2);
    navigator->update({x, data.target(row + 1), data.times_s[row + 1]});
    if (disguised && !*navigator->believes()) {
      found_s = std::min(found_s, data.times_s[row + 1] - data.times_s[outage.begin]);
    }
    const auto mean = [&](std::size_t state) { return 0.5 * (now[state] + next[state]); };
    truth.advance(mean(0), mean(1), mean(2), dt_s);
    reckoned.advance(0.5 * (u + navigator->velocity(0)), 0.5 * (v + navigator->velocity(1)),
                     plan.yaw_rate ? mean(2) : 0.5 * (r + navigator->velocity(2)), dt_s);
    distance += std::hypot(mean(0), mean(1)) * dt_s;
  }
  if (distance <= kStill) {
    return;
  }
  const double x = reckoned.x - truth.x;
  const double y = reckoned.y - truth.y;
  score.errors.push_back(std::hypot(x, y) / distance);
  if (disguised) {
    score.found_s.push_back(found_s);
  }
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

// All navigators on their way along a log, and their scores.
class OutageStudy {
 public:
  OutageStudy(const log::Dataset& data, std::span<const std::size_t> rows, std::string label,
              const ReckoningPlan& plan)
      : data_(data), plan_(plan), outages_(plan_outages(data, rows, plan)) {
    result_ = {.source = data.source,
               .split = std::move(label),
               .yaw_rate = plan.yaw_rate,
               .held_out = rows.size(),
               .scores = {}};
  }

  // The next row, and copies of the navigators through the outages that begin there.
  void take(std::size_t row, const std::vector<NamedNavigator>& navigators) {
    if (result_.scores.empty()) {
      begin_scores(navigators);
    }
    for (std::size_t i = 0; i < navigators.size(); ++i) {
      Navigator& navigator = *navigators[i].navigator;
      navigator.update(sensed(data_, row));
      ++result_.scores[i].measured;
      result_.scores[i].disbelieved += navigator.believes().value_or(true) ? 0 : 1;
    }
    for (; next_ < outages_.size() && outages_[next_].begin <= row; ++next_) {
      for (std::size_t i = 0; outages_[next_].begin == row && i < navigators.size(); ++i) {
        go_through(*navigators[i].navigator, data_, outages_[next_], plan_,
                   result_.scores[i].outages[outages_[next_].length]);
      }
    }
  }

  bool goes_on(std::size_t row) const {
    return next_ < outages_.size() &&
           (row % 100 != 0 ||
            plan_.keep_going(static_cast<double>(row) / static_cast<double>(data_.rows())));
  }

  const ReckoningResult& result() const { return result_; }

 private:
  void begin_scores(const std::vector<NamedNavigator>& navigators) {
    for (const NamedNavigator& one : navigators) {
      NavigatorScore& score = result_.scores.emplace_back();
      score.name = one.name;
      for (const double seconds : plan_.outages_s) {
        score.outages.push_back({.seconds = seconds, .errors = {}, .steps = {}, .found_s = {}});
      }
    }
  }

  const log::Dataset& data_;
  const ReckoningPlan& plan_;
  std::vector<Outage> outages_;
  std::size_t next_ = 0;
  ReckoningResult result_;
};

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

double found_quantile(const OutageScore& score, double share) {
  std::vector<double> times = score.found_s;
  return times.empty() ? std::numeric_limits<double>::quiet_NaN() : quantile(times, share);
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
    if (!navigator.outages.front().found_s.empty()) {
      add_shares(table, navigator, "loss found, median s",
                 [](const OutageScore& score) { return found_quantile(score, 0.5); });
      add_shares(table, navigator, "longest s",
                 [](const OutageScore& score) { return found_quantile(score, 1.0); });
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
          {"found_s", file::numbers(score.found_s)},
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
                               {"measured_rows", navigator.measured},
                               {"disbelieved_rows", navigator.disbelieved},
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
      mine.found_s.insert(mine.found_s.end(), theirs.found_s.begin(), theirs.found_s.end());
    }
    scores[i].measured += other.scores[i].measured;
    scores[i].disbelieved += other.scores[i].disbelieved;
  }
}

ReckoningResult measure_reckoning(const log::Dataset& data, const study::Split& split,
                                  const ReckoningPlan& plan) {
  NavigatorSet set(data, plan.settings);
  for (const std::size_t row : split.training) {
    set.learn(row);
  }
  set.learn_held_back();
  set.renew();
  const std::vector<NamedNavigator> fresh = copies(set.navigators());
  OutageStudy study(data, split.held_out, split.label, plan);
  for (std::size_t row = 0; row < data.rows() && study.goes_on(row); ++row) {
    if (row > 0 && data.configurations[row] != data.configurations[row - 1]) {
      set.navigators() = copies(fresh);  // another drive
    }
    study.take(row, set.navigators());
  }
  return study.result();
}

ReckoningResult measure_live_reckoning(const log::Dataset& data, const ReckoningPlan& plan) {
  std::vector<std::size_t> rows(data.rows());
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  std::erase_if(
      rows, [&](std::size_t row) { return data.times_s[row] < data.times_s.front() + kFirstS; });
  NavigatorSet set(data, plan.settings);
  OutageStudy study(data, rows, "learned while driving", plan);
  double renewed_s = data.times_s.front();
  for (std::size_t row = 0; row < data.rows() && study.goes_on(row); ++row) {
    study.take(row, set.navigators());
    set.learn(row);
    if (data.times_s[row] >= renewed_s + kRenewedS) {
      set.try_to_renew();
      renewed_s = data.times_s[row];
    }
  }
  return study.result();
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
