// SPDX-License-Identifier: Apache-2.0
#include "identify/weak_form.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/quantile.hpp"
#include "identify/tuning.hpp"

namespace kelpie {
namespace {

// φ(s) = (1 − s²)³ within ±1: it and its first two derivatives vanish at the ends.
double bump(double s) {
  return std::pow(1.0 - s * s, 3.0);
}

double bump_slope(double s) {
  return -6.0 * s * std::pow(1.0 - s * s, 2.0);
}

// Weights of the rows of one window, by the trapezoidal rule.
struct Window {
  std::size_t first = 0;
  std::vector<double> mean{};   // sum 1
  std::vector<double> slope{};  // of the velocity: 0 for a constant, 1 for time
};

Window window_at(std::span<const double> times, std::size_t begin, std::size_t end, double centre_s,
                 double half_s) {
  Window window;
  while (times[begin] <= centre_s - half_s) {
    ++begin;
  }
  window.first = begin;
  double area = 0.0;
  double drift = 0.0;
  for (std::size_t row = begin; row < end && times[row] < centre_s + half_s; ++row) {
    const double left = row > 0 ? times[row] - times[row - 1] : 0.0;
    const double right = row + 1 < end ? times[row + 1] - times[row] : 0.0;
    const double s = (times[row] - centre_s) / half_s;
    window.mean.push_back(0.5 * (left + right) * bump(s));
    window.slope.push_back(-0.5 * (left + right) * bump_slope(s));
    area += window.mean.back();
    drift += window.slope.back();
  }
  double gain = 0.0;
  for (std::size_t i = 0; i < window.mean.size(); ++i) {
    window.mean[i] /= area;
    window.slope[i] -= drift * window.mean[i];  // rows needn't be evenly spaced
    gain += window.slope[i] * (times[window.first + i] - centre_s);
  }
  for (double& weight : window.slope) {
    weight /= gain;
  }
  return window;
}

bool is_spike(const Eigen::Ref<const Eigen::RowVectorXd>& values,
              const Eigen::Ref<const Eigen::RowVectorXd>& usual) {
  return (values.array().abs() > kIdentification.spike_factor * usual.array()).any() ||
         !values.allFinite();
}

Eigen::RowVectorXd usual_size(const Eigen::MatrixXd& values) {
  Eigen::RowVectorXd usual(values.cols());
  for (Eigen::Index column = 0; column < values.cols(); ++column) {
    std::vector<double> sizes;
    for (Eigen::Index row = 0; row < values.rows(); ++row) {
      if (values(row, column) != 0.0) {
        sizes.push_back(std::abs(values(row, column)));
      }
    }
    usual(column) = sizes.empty() ? 0.0 : quantile(sizes, 0.9);
  }
  return usual;
}

void drop_spikes(WeakRows& weak) {
  const Eigen::RowVectorXd terms = usual_size(weak.terms);
  const Eigen::RowVectorXd accelerations = usual_size(weak.acceleration);
  Eigen::Index kept = 0;
  for (Eigen::Index row = 0; row < weak.terms.rows(); ++row) {
    if (!is_spike(weak.terms.row(row), terms) &&
        !is_spike(weak.acceleration.row(row), accelerations)) {
      weak.terms.row(kept) = weak.terms.row(row);
      weak.acceleration.row(kept) = weak.acceleration.row(row);
      weak.given.row(kept) = weak.given.row(row);
      ++kept;
    }
  }
  weak.terms.conservativeResize(kept, Eigen::NoChange);
  weak.acceleration.conservativeResize(kept, Eigen::NoChange);
  weak.given.conservativeResize(kept, Eigen::NoChange);
}

std::vector<Window> all_windows(const EquationRows& rows, const WindowShape& shape) {
  std::vector<Window> windows;
  for (std::size_t stretch = 0; stretch < rows.starts.size(); ++stretch) {
    std::size_t begin = rows.starts[stretch];
    const std::size_t end =
        stretch + 1 < rows.starts.size() ? rows.starts[stretch + 1] : rows.times_s.size();
    if (begin == end) {
      continue;
    }
    const double last = rows.times_s[end - 1] - shape.half_s;
    for (double centre = rows.times_s[begin] + shape.half_s; centre <= last;
         centre += shape.stride_s) {
      while (rows.times_s[begin] <= centre - shape.half_s - shape.stride_s) {
        ++begin;
      }
      Window window = window_at(rows.times_s, begin, end, centre, shape.half_s);
      if (window.mean.size() >= kIdentification.window_rows) {
        windows.push_back(std::move(window));
      }
    }
  }
  return windows;
}

// The trapezoidal rule gives half of an interval to the speed at either end: with steps both halves
// belong to one of the ends.
void integrate_steps(const EquationRows& rows, BetweenRows between,
                     Eigen::Ref<Eigen::MatrixXd> thrusts) {
  const Eigen::MatrixXd own = thrusts;
  const Eigen::Index later = between == BetweenRows::steps_after ? 1 : 0;
  const auto count = static_cast<std::size_t>(own.rows());
  for (std::size_t stretch = 0; stretch < rows.starts.size(); ++stretch) {
    const std::size_t end = stretch + 1 < rows.starts.size() ? rows.starts[stretch + 1] : count;
    for (std::size_t row = rows.starts[stretch]; row + 1 < end; ++row) {
      const auto first = static_cast<Eigen::Index>(row);
      thrusts.row(first + later) = 0.5 * (own.row(first) + own.row(first + 1));
    }
  }
}

}  // namespace

void PlanarTerms::evaluate(std::span<const double, kPlanarAxes> velocity,
                           std::span<const double> speeds, Eigen::Ref<Eigen::VectorXd> terms) {
  std::ranges::copy(velocity, inputs_.begin());
  std::ranges::copy(speeds, inputs_.begin() + kPlanarAxes);
  terms_.evaluate(inputs_, std::span(terms.data(), terms_.size()));
}

WeakRows weak_rows(const EquationRows& rows, const WindowShape& shape) {
  const std::vector<Window> windows = all_windows(rows, shape);
  const auto count = static_cast<Eigen::Index>(windows.size());
  const Eigen::Index axes = rows.velocities.cols();
  WeakRows weak{Eigen::MatrixXd::Zero(count, axes), Eigen::MatrixXd::Zero(count, rows.terms.cols()),
                Eigen::MatrixXd::Zero(count, axes)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const Window& window = windows[static_cast<std::size_t>(i)];
    for (std::size_t k = 0; k < window.mean.size(); ++k) {
      const auto row = static_cast<Eigen::Index>(window.first + k);
      weak.terms.row(i) += window.mean[k] * rows.terms.row(row);
      weak.acceleration.row(i) += window.slope[k] * rows.velocities.row(row);
      if (rows.given.size() > 0) {
        weak.given.row(i) += window.mean[k] * rows.given.row(row);
      }
    }
  }
  drop_spikes(weak);
  return weak;
}

WeakRows weak_rows(const PlanarRows& rows, std::span<const double> accelerations,
                   BetweenRows between) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto count = static_cast<Eigen::Index>(rows.rows());
  EquationRows equation{.times_s = rows.times_s,
                        .starts = rows.starts,
                        .velocities = Eigen::Map<const RowMajor>(rows.velocities.data(), count, 3),
                        .terms = Eigen::MatrixXd(count, term_count(rows.thrusters.size()))};
  if (!accelerations.empty()) {
    equation.given = Eigen::Map<const RowMajor>(accelerations.data(), count, 3);
  }
  PlanarTerms evaluated(rows.thrusters.size());
  Eigen::VectorXd row_terms(equation.terms.cols());
  for (Eigen::Index row = 0; row < count; ++row) {
    const auto at = static_cast<std::size_t>(row);
    evaluated.evaluate(rows.velocity(at), rows.speed(at), row_terms);
    equation.terms.row(row) = row_terms.transpose();
  }
  if (between != BetweenRows::ramps) {
    integrate_steps(equation, between,
                    equation.terms.rightCols(equation.terms.cols() - kTermThrusters));
  }
  return weak_rows(equation, kPlanarWindow);
}

}  // namespace kelpie
