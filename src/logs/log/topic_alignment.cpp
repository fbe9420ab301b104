// SPDX-License-Identifier: Apache-2.0
#include "log/topic_alignment.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "kelpie/core/error.hpp"
#include "log/regression_columns.hpp"

namespace kelpie::log {
namespace {

using Matrix = Eigen::MatrixXd;

constexpr std::size_t kRowsPerCoefficient = 10;
constexpr double kRidge = 1e-9;  // of columns with unit variance: two thrusters may go as one

[[noreturn]] void refuse(const std::string& message) {
  throw InputError("lag", message);
}

class TopicAlignmentSearch {
 public:
  explicit TopicAlignmentSearch(const TopicAlignmentProblem& problem)
      : problem_(problem),
        steps_(static_cast<std::size_t>(std::ceil(TopicAlignment::kFarthest / problem.step_s))) {
    const ColumnList drag = drag_terms(problem.background);
    std::vector<std::vector<ColumnList>> thrust;  // [topic][step]
    thrust.reserve(problem.groups.size());
    for (const TopicAlignmentProblem::Group& group : problem.groups) {
      thrust.push_back(shifts_of(group));
    }
    choose_rows(drag, thrust);
    targets_ = standardised(problem.responses, rows_);
    drag_ = standardised(drag, rows_);
    for (const std::vector<ColumnList>& group : thrust) {
      std::vector<Matrix>& matrices = thrust_.emplace_back();
      for (const ColumnList& shift : group) {
        matrices.push_back(standardised(shift, rows_));
      }
    }
  }

  TopicAlignment run() const {
    std::vector<std::size_t> lags(thrust_.size(), steps_);
    TopicAlignment result{.topics = {}, .rows = rows_.size(), .explained_at_zero = explained(lags)};
    const Best common = best(0, 2 * steps_, [&](std::size_t step) {
      return explained(std::vector(thrust_.size(), step));
    });
    if (!common.is_inside) {
      refuse(
          fmt::format("the accelerations fit best at the end of the range of ± {} s: no lag can "
                      "be told from these rows; give it in s",
                      TopicAlignment::kFarthest));
    }
    std::ranges::fill(lags, common.step);
    result.explained = common.explained;
    const auto near =
        static_cast<std::size_t>(std::ceil(TopicAlignment::kOwnRange / problem_.step_s));
    for (std::size_t topic = 0; topic < lags.size(); ++topic) {
      const Best own = best(common.step - std::min(common.step, near),
                            std::min(common.step + near, 2 * steps_), [&](std::size_t step) {
                              std::vector<std::size_t> with = lags;
                              with[topic] = step;
                              return explained(with);
                            });
      const double gain = (own.explained - result.explained) / (1.0 - result.explained);
      const bool is_own = lags.size() == 1 || (own.is_inside && gain > TopicAlignment::kOwnGain);
      if (is_own) {
        lags[topic] = own.step;
        result.explained = own.explained;
      }
      result.topics.push_back({.topic = problem_.groups[topic].topic,
                               .lag_s = is_own ? own.lag_s : common.lag_s,
                               .is_own = is_own});
    }
    return result;
  }

 private:
  struct Best {
    std::size_t step = 0;
    double lag_s = 0.0;
    double explained = 0.0;
    bool is_inside = false;  // not at an end of the range
  };

  double lag_of(double step) const {
    return (step - static_cast<double>(steps_)) * problem_.step_s;
  }

  // [step][signal][row] of n|n|.
  std::vector<ColumnList> shifts_of(const TopicAlignmentProblem::Group& group) const {
    std::vector<ColumnList> shifts;
    for (std::size_t step = 0; step <= 2 * steps_; ++step) {
      const double lag_s = lag_of(static_cast<double>(step));
      ColumnList& columns = shifts.emplace_back();
      for (const SignalHistory* const signal : group.signals) {
        std::vector<double>& column = columns.emplace_back();
        for (const double t : problem_.times_s) {
          const double n = signal->at(t + lag_s, group.between);
          column.push_back(n * std::abs(n));
        }
      }
    }
    return shifts;
  }

  // The same rows for every lag, so that what they explain can be compared.
  void choose_rows(const ColumnList& drag, const std::vector<std::vector<ColumnList>>& thrust) {
    std::size_t coefficients = 1 + drag.size();
    std::vector<const std::vector<double>*> all;
    const auto use = [&](const ColumnList& columns) {
      std::ranges::for_each(columns, [&](const auto& column) { all.push_back(&column); });
    };
    use(problem_.responses);
    use(drag);
    for (const std::vector<ColumnList>& group : thrust) {
      coefficients += group.front().size();
      std::ranges::for_each(group, use);
    }
    for (std::size_t row = 0; row < problem_.times_s.size(); ++row) {
      if (std::ranges::all_of(all, [&](const auto* c) { return std::isfinite((*c)[row]); })) {
        rows_.push_back(row);
      }
    }
    if (rows_.size() < kRowsPerCoefficient * coefficients) {
      refuse(
          fmt::format("{} rows have all values within ± {} s; to tell lags from them {} are "
                      "needed; give the lags in s",
                      rows_.size(), TopicAlignment::kFarthest, kRowsPerCoefficient * coefficients));
    }
  }

  // Share of the targets' variance that the fit with these lags explains.
  double explained(const std::vector<std::size_t>& lags) const {
    Eigen::Index width = drag_.cols();
    for (const std::vector<Matrix>& group : thrust_) {
      width += group.front().cols();
    }
    Matrix design(targets_.rows(), width);
    design.leftCols(drag_.cols()) = drag_;
    Eigen::Index column = drag_.cols();
    for (std::size_t topic = 0; topic < thrust_.size(); ++topic) {
      const Matrix& shifted = thrust_[topic][lags[topic]];
      design.middleCols(column, shifted.cols()) = shifted;
      column += shifted.cols();
    }
    Matrix normal = design.transpose() * design;
    normal.diagonal().array() += kRidge * static_cast<double>(rows_.size());
    const Matrix weights = normal.ldlt().solve(design.transpose() * targets_);
    const double left = (targets_ - design * weights).squaredNorm();
    return 1.0 - left / std::max(targets_.squaredNorm(), kRidge);
  }

  template <typename Explained>
  Best best(std::size_t first, std::size_t last, Explained explained_at) const {
    std::vector<double> shares;
    for (std::size_t step = first; step <= last; ++step) {
      shares.push_back(explained_at(step));
    }
    const auto top = static_cast<std::size_t>(std::ranges::max_element(shares) - shares.begin());
    const bool is_inside = top > 0 && top + 1 < shares.size();
    double between = 0.0;
    if (is_inside) {
      const double bend = shares[top - 1] - 2.0 * shares[top] + shares[top + 1];
      between = bend < 0.0 ? 0.5 * (shares[top - 1] - shares[top + 1]) / bend : 0.0;
    }
    return {first + top, lag_of(static_cast<double>(first + top) + between), shares[top],
            is_inside};
  }

  const TopicAlignmentProblem& problem_;
  std::size_t steps_;  // of the search, on either side of 0
  std::vector<std::size_t> rows_;
  Matrix targets_;
  Matrix drag_;
  std::vector<std::vector<Matrix>> thrust_;  // [topic][step]
};

}  // namespace

TopicAlignment align_topics(const TopicAlignmentProblem& problem) {
  return TopicAlignmentSearch(problem).run();
}

}  // namespace kelpie::log
