// SPDX-License-Identifier: Apache-2.0
#include "log/pose_window_search.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "kelpie/core/error.hpp"
#include "log/regression_columns.hpp"
#include "log/streamed_signals.hpp"
#include "log/tuning.hpp"
#include "stream/tuning.hpp"

namespace kelpie::log {
namespace {

constexpr auto& kSearch = kTuning.pose_window;

// Of every signal the samples up to a time.
std::vector<Signal> first_part(const std::vector<Signal>& signals, double until_s) {
  std::vector<Signal> part = signals;
  for (Signal& signal : part) {
    const auto end = std::ranges::upper_bound(signal.times_s, until_s);
    const auto kept = static_cast<std::size_t>(end - signal.times_s.begin());
    signal.times_s.resize(kept);
    signal.values.resize(kept);
  }
  return part;
}

// Shares of the variance of each column of `targets` that a fit on the other folds explains.
Eigen::VectorXd explained_on_folds(const Eigen::MatrixXd& design, const Eigen::MatrixXd& targets) {
  const Eigen::Index rows = design.rows();
  Eigen::VectorXd left = Eigen::VectorXd::Zero(targets.cols());
  std::vector<int> fold(static_cast<std::size_t>(rows));
  for (Eigen::Index row = 0; row < rows; ++row) {
    fold[static_cast<std::size_t>(row)] =
        static_cast<int>(row * kSearch.pieces / rows) % kSearch.folds;
  }
  for (int out = 0; out < kSearch.folds; ++out) {
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(design.cols(), design.cols());
    Eigen::MatrixXd moments = Eigen::MatrixXd::Zero(design.cols(), targets.cols());
    for (Eigen::Index row = 0; row < rows; ++row) {
      if (fold[static_cast<std::size_t>(row)] != out) {
        normal.selfadjointView<Eigen::Lower>().rankUpdate(design.row(row).transpose());
        moments += design.row(row).transpose() * targets.row(row);
      }
    }
    normal.diagonal().array() += kSearch.ridge * static_cast<double>(rows);
    const Eigen::MatrixXd weights =
        normal.selfadjointView<Eigen::Lower>().ldlt().solve(moments).eval();
    for (Eigen::Index row = 0; row < rows; ++row) {
      if (fold[static_cast<std::size_t>(row)] == out) {
        left +=
            (targets.row(row) - design.row(row) * weights).array().square().matrix().transpose();
      }
    }
  }
  return Eigen::VectorXd::Ones(targets.cols()) -
         left.cwiseQuotient(targets.colwise().squaredNorm().transpose().cwiseMax(1e-300));
}

class PoseWindowSearch {
 public:
  PoseWindowSearch(const StreamPlan& plan, const std::vector<Signal>& signals, double until_s)
      : plan_(plan), signals_(first_part(signals, until_s)) {}

  PoseWindowChoice run() {
    PoseWindowChoice choice;
    const double longest_s =
        std::min(0.5 * stream::kTuning.longest_window_s, (last_s() - first_s()) / kSearch.windows);
    const double shortest_s = kSearch.least_steps * slowest_step_s();
    for (double half_s = shortest_s; half_s <= longest_s; half_s *= std::numbers::sqrt2) {
      const PoseWindowChoice::Tried tried = try_window(half_s);
      if (!tried.explained.empty()) {
        choice.tried.push_back(tried);
      }
    }
    if (shortest_s > longest_s) {
      throw InputError(
          "window",
          fmt::format("poses come every {:.3g} s, which takes a window of {:.3g} s at least; in "
                      "the {:.3g} s of the log that the search takes such windows are too few: "
                      "give the window in s, or a longer log",
                      slowest_step_s(), 2.0 * shortest_s, last_s() - first_s()));
    }
    if (choice.tried.empty()) {
      throw InputError("window",
                       fmt::format("no window between {:.3g} and {:.3g} s has rows enough to find "
                                   "the window of the pose; give it in s",
                                   2.0 * shortest_s, 2.0 * longest_s));
    }
    choice.half_s =
        std::ranges::max_element(choice.tried, {}, &PoseWindowChoice::Tried::score)->half_s;
    return choice;
  }

 private:
  double slowest_step_s() const {
    double step_s = 0.0;
    for (const std::string& name : plan_.pose->sources()) {
      step_s = std::max(step_s, median_step_s(signals_[plan_.source(name)]));
    }
    return step_s;
  }
  double first_s() const {
    double first = -std::numeric_limits<double>::infinity();
    for (const std::string& name : plan_.pose->sources()) {
      const Signal& signal = signals_[plan_.source(name)];
      first = std::max(first, signal.times_s.empty() ? 0.0 : signal.times_s.front());
    }
    return first;
  }
  double last_s() const {
    double last = std::numeric_limits<double>::infinity();
    for (const std::string& name : plan_.pose->sources()) {
      const Signal& signal = signals_[plan_.source(name)];
      last = std::min(last, signal.times_s.empty() ? 0.0 : signal.times_s.back());
    }
    return last;
  }

  PoseWindowChoice::Tried try_window(double half_s) const {
    StreamPlan plan = plan_;
    plan.pose->half_s = half_s;
    plan.rate_hz = std::min(plan_.rate_hz, kSearch.rows_per_window / (2.0 * half_s));
    StreamedSignals streamed(plan, signals_);
    ColumnList velocities;
    ColumnList others;
    ColumnList commands;
    ColumnList targets;
    sort_columns(plan, std::move(streamed.columns), velocities, others, commands, targets);
    std::vector<std::size_t> rows;
    for (std::size_t row = 0; row < streamed.times_s.size(); ++row) {
      const auto is_whole = [&](const ColumnList& columns) {
        return std::ranges::all_of(columns,
                                   [&](const auto& column) { return std::isfinite(column[row]); });
      };
      if (is_whole(velocities) && is_whole(others) && is_whole(commands) && is_whole(targets)) {
        rows.push_back(row);
      }
    }
    return judged(half_s, rows, velocities, others, commands, targets);
  }

  // Inputs of the rows: velocities, other states, n and n|n| of commands; targets: accelerations.
  static void sort_columns(const StreamPlan& plan, ColumnList columns, ColumnList& velocities,
                           ColumnList& others, ColumnList& commands, ColumnList& targets) {
    const std::vector<std::string> slopes = plan.pose->accelerations();
    const auto& names = StreamPlan::Pose::kVelocities;
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const std::string& name = plan.inputs[k];
      const auto source = std::ranges::find(plan.sources, name, &StreamPlan::Source::name);
      if (std::ranges::count(slopes, name) > 0) {
        targets.push_back(std::move(columns[k]));
      } else if (std::ranges::count(names, name) > 0) {
        velocities.push_back(std::move(columns[k]));
      } else if (source == plan.sources.end() || source->between != Interpolation::hold) {
        others.push_back(std::move(columns[k]));
      } else {
        std::vector<double>& square = commands.emplace_back(columns[k]);
        std::ranges::for_each(square, [](double& n) { n *= std::abs(n); });
        commands.push_back(std::move(columns[k]));
      }
    }
  }

  static PoseWindowChoice::Tried judged(double half_s, const std::vector<std::size_t>& rows,
                                        const ColumnList& velocities, const ColumnList& others,
                                        const ColumnList& commands, const ColumnList& targets) {
    PoseWindowChoice::Tried tried{.half_s = half_s, .rows = rows.size()};
    ColumnList background = drag_terms(velocities);
    background.insert(background.end(), others.begin(), others.end());
    const auto width = static_cast<Eigen::Index>(background.size());
    const auto thrusts = static_cast<Eigen::Index>(commands.size());
    if (static_cast<Eigen::Index>(rows.size()) < kSearch.rows_per_coefficient * (width + thrusts)) {
      return tried;
    }
    Eigen::MatrixXd design(static_cast<Eigen::Index>(rows.size()), width + thrusts);
    design.leftCols(width) = standardised(background, rows);
    design.rightCols(thrusts) = standardised(commands, rows);
    const Eigen::MatrixXd wanted = standardised(targets, rows);
    const Eigen::VectorXd with = explained_on_folds(design, wanted);
    const Eigen::VectorXd without = thrusts > 0 ? explained_on_folds(design.leftCols(width), wanted)
                                                : Eigen::VectorXd::Zero(wanted.cols());
    for (Eigen::Index axis = 0; axis < with.size(); ++axis) {
      const double gain = std::max(with(axis) - without(axis), kSearch.least_gain);
      const double left = std::max(1.0 - with(axis), kSearch.least_gain);
      tried.score += std::log(gain / left / half_s);
      tried.explained.push_back(with(axis));
      tried.without_commands.push_back(without(axis));
    }
    return tried;
  }

  const StreamPlan& plan_;
  std::vector<Signal> signals_;
};

}  // namespace

PoseWindowChoice find_pose_window(const StreamPlan& plan, const std::vector<Signal>& signals,
                                  double until_s) {
  return PoseWindowSearch(plan, signals, until_s).run();
}

}  // namespace kelpie::log
