// SPDX-License-Identifier: Apache-2.0
#include "alignment/current_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "alignment/tuning.hpp"
#include "core/decomposition.hpp"
#include "core/eigen.hpp"

namespace kelpie {
namespace {

constexpr const auto& kWaterFit = kAlignmentTuning.water;
constexpr const auto& kFoldFit = kAlignmentTuning.alignment;

// Where a time lies among evenly spread knots.
struct KnotPlace {
  Eigen::Index knot = 0;
  double beyond = 0.0;  // share of the way to the next
};

KnotPlace knot_at(double t, double first, double last, Eigen::Index knots) {
  if (knots < 2 || !(last > first)) {
    return {};
  }
  const double at =
      std::clamp((t - first) / (last - first), 0.0, 1.0) * static_cast<double>(knots - 1);
  const auto knot = std::min(static_cast<Eigen::Index>(at), knots - 2);
  return {knot, at - static_cast<double>(knot)};
}

std::vector<std::size_t> rest_of(const std::vector<std::size_t>& some, std::size_t count) {
  std::vector<std::size_t> rest;
  for (std::size_t i = 0; i < count; ++i) {
    if (std::ranges::find(some, i) == some.end()) {
      rest.push_back(i);
    }
  }
  return rest;
}

}  // namespace

CurrentFit::CurrentFit(const AlignmentProblem& problem, const PlanarPlaces& places,
                       std::span<const double> headings_rad)
    : places_(places),
      list_(MotionTerms::alignment(problem.input_names.size(),
                                   rest_of(find_commands(problem), problem.input_names.size()))) {
  const AlignmentRows rows(problem);
  const std::size_t every = 1 + (rows.size() - 1) / kWaterFit.most_fitted_rows;
  const auto count = static_cast<Eigen::Index>((rows.size() - 1) / every + 1);
  x_.resize(static_cast<Eigen::Index>(rows.inputs.size()), count);
  y_.resize(static_cast<Eigen::Index>(rows.targets.size()), count);
  t_.resize(count);
  cos_.resize(count);
  sin_.resize(count);
  const std::size_t blocks = kFolds * kWaterFit.blocks_per_fold;
  for (Eigen::Index row = 0; row < count; ++row) {
    const std::size_t at = static_cast<std::size_t>(row) * every;
    for (std::size_t i = 0; i < rows.inputs.size(); ++i) {
      x_(static_cast<Eigen::Index>(i), row) = rows.inputs[i][at] * rows.largest[i];
    }
    for (std::size_t i = 0; i < rows.targets.size(); ++i) {
      y_(static_cast<Eigen::Index>(i), row) = rows.targets[i][at] * rows.largest_target[i];
    }
    t_[row] = problem.times_s[problem.rows[at]];
    cos_[row] = std::cos(headings_rad[at]);
    sin_[row] = std::sin(headings_rad[at]);
    fold_.push_back(at * blocks / rows.size() % kFolds);
  }
  scale_ = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(list_.size()));
  Water still = through(Eigen::VectorXd());
  scale_ = (still.phi.rowwise().squaredNorm() / static_cast<double>(count)).cwiseSqrt();
  scale_ = (scale_.array() > 0.0).select(scale_, 1.0);
  still.phi.array().colwise() /= scale_.array();
  const Eigen::ArrayXd mean = y_.rowwise().mean();
  variance_ = (y_.array().colwise() - mean).square().rowwise().mean().max(kFoldFit.least_variance);
  usual_ = variance_.sqrt();
  Rows all(static_cast<std::size_t>(count));
  std::iota(all.begin(), all.end(), Eigen::Index{0});
  const Weights weights = this->weights(still, all);
  const Eigen::MatrixXd errors = still.y - weights.of.transpose() * still.phi;
  usual_ = (errors.rowwise().squaredNorm().array() / static_cast<double>(count))
               .max(kFoldFit.rounding * variance_)
               .sqrt();
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(2);
  const std::vector<Eigen::MatrixXd> slopes = this->slopes(none, still, weights);
  for (Eigen::Index target = 0; target < y_.rows(); ++target) {
    information_ +=
        slopes[static_cast<std::size_t>(target)].squaredNorm() / (usual_[target] * usual_[target]);
  }
}

std::vector<double> CurrentFit::knots(std::size_t count) const {
  std::vector<double> times_s;
  for (std::size_t i = 0; i < count; ++i) {
    const double share = count == 1 ? 0.0 : static_cast<double>(i) / static_cast<double>(count - 1);
    times_s.push_back(t_[0] + share * (t_[t_.size() - 1] - t_[0]));
  }
  return times_s;
}

CurrentFit::Water CurrentFit::through(const Eigen::VectorXd& current) const {
  const auto terms = static_cast<Eigen::Index>(list_.size());
  Water water{.phi = Eigen::MatrixXd(terms, x_.cols()), .y = y_};
  Eigen::VectorXd x(x_.rows());
  for (Eigen::Index row = 0; row < x_.cols(); ++row) {
    x = x_.col(row);
    if (current.size() > 0) {
      const auto [knot, beyond] = knot_at(t_[row], t_[0], t_[t_.size() - 1], current.size() / 2);
      const Eigen::Index next = std::min(knot + 1, current.size() / 2 - 1);
      const Eigen::Vector2d c =
          (1.0 - beyond) * current.segment<2>(2 * knot) + beyond * current.segment<2>(2 * next);
      const double surge = c[0] * cos_[row] + c[1] * sin_[row];
      const double sway = c[1] * cos_[row] - c[0] * sin_[row];
      const double r = x[static_cast<Eigen::Index>(places_.yaw_rate)];
      x[static_cast<Eigen::Index>(places_.surge)] -= surge;
      x[static_cast<Eigen::Index>(places_.sway)] -= sway;
      water.y(static_cast<Eigen::Index>(places_.surge_target), row) -= r * sway;
      water.y(static_cast<Eigen::Index>(places_.sway_target), row) += r * surge;
    }
    list_.evaluate({x.data(), static_cast<std::size_t>(x.size())},
                   {water.phi.col(row).data(), static_cast<std::size_t>(terms)});
  }
  water.phi.array().colwise() /= scale_.array();
  return water;
}

CurrentFit::Weights CurrentFit::weights(const Water& water, const Rows& rows) const {
  const Eigen::MatrixXd phi = water.phi(Eigen::all, rows);
  const Eigen::MatrixXd y = water.y(Eigen::all, rows);
  Eigen::MatrixXd gram = phi * phi.transpose();
  gram.diagonal().array() += kFoldFit.unit_ridge;
  Weights found;
  found.projector = solve_symmetric(gram, phi);
  found.of = found.projector * y.transpose();
  const Eigen::MatrixXd errors = y - found.of.transpose() * phi;
  found.squares = (errors.array().colwise() / usual_).square().sum();
  return found;
}

// Of what the model and the turning frame make of the current: row × 2 knots for every target.
std::vector<Eigen::MatrixXd> CurrentFit::slopes(const Eigen::VectorXd& current, const Water& water,
                                                const Weights& weights) const {
  const Eigen::Index knots = current.size() / 2;
  std::vector<Eigen::MatrixXd> slopes(static_cast<std::size_t>(y_.rows()),
                                      Eigen::MatrixXd::Zero(x_.cols(), current.size()));
  for (Eigen::Index component = 0; component < 2; ++component) {
    Eigen::VectorXd moved = current;
    moved(Eigen::seqN(component, knots, 2)).array() += kWaterFit.difference_m_s;
    const Water there = through(moved);
    const Eigen::MatrixXd change =
        (weights.of.transpose() * (there.phi - water.phi) - (there.y - water.y)) /
        kWaterFit.difference_m_s;
    for (Eigen::Index row = 0; row < x_.cols(); ++row) {
      const auto [knot, beyond] = knot_at(t_[row], t_[0], t_[t_.size() - 1], knots);
      for (Eigen::Index axis = 0; axis < y_.rows(); ++axis) {
        Eigen::MatrixXd& slope = slopes[static_cast<std::size_t>(axis)];
        slope(row, 2 * knot + component) = (1.0 - beyond) * change(axis, row);
        if (beyond > 0.0) {
          slope(row, 2 * (knot + 1) + component) = beyond * change(axis, row);
        }
      }
    }
  }
  return slopes;
}

// A current of few rows is like its neighbours.
Eigen::MatrixXd CurrentFit::penalty(Eigen::Index knots) const {
  const double share = information_ / static_cast<double>(2 * knots);
  Eigen::MatrixXd penalty =
      Eigen::MatrixXd::Identity(2 * knots, 2 * knots) * kWaterFit.still * share;
  for (Eigen::Index i = 0; i + 2 < 2 * knots; ++i) {
    penalty(i, i) += kWaterFit.smooth * share;
    penalty(i + 2, i + 2) += kWaterFit.smooth * share;
    penalty(i, i + 2) -= kWaterFit.smooth * share;
    penalty(i + 2, i) -= kWaterFit.smooth * share;
  }
  return penalty;
}

Eigen::VectorXd CurrentFit::step(const Eigen::VectorXd& current, const Water& water,
                                 const Weights& weights, const Rows& rows) const {
  Eigen::MatrixXd normal = penalty(current.size() / 2);
  Eigen::VectorXd right = -normal * current;
  const Eigen::MatrixXd phi = water.phi(Eigen::all, rows);
  const std::vector<Eigen::MatrixXd> slopes = this->slopes(current, water, weights);
  for (Eigen::Index target = 0; target < y_.rows(); ++target) {
    Eigen::MatrixXd slope = slopes[static_cast<std::size_t>(target)](rows, Eigen::all);
    slope -= phi.transpose() * (weights.projector * slope);
    const Eigen::VectorXd error =
        water.y(target, rows).transpose() - phi.transpose() * weights.of.col(target);
    const double weight = 1.0 / (usual_[target] * usual_[target]);
    normal += weight * slope.transpose() * slope;
    right += weight * slope.transpose() * error;
  }
  return solve_symmetric(normal, right);
}

Eigen::VectorXd CurrentFit::descend(Eigen::VectorXd current, const Rows& rows) const {
  if (current.size() == 0) {
    return current;
  }
  const Eigen::MatrixXd penalty = this->penalty(current.size() / 2);
  const auto cost = [&](const Eigen::VectorXd& at, const Weights& weights) {
    return weights.squares + at.dot(penalty * at);
  };
  Water water = through(current);
  Weights weights = this->weights(water, rows);
  for (int i = 0; i < kWaterFit.most_steps; ++i) {
    const double before = cost(current, weights);
    Eigen::VectorXd step = this->step(current, water, weights, rows);
    bool better = false;
    for (int half = 0; half < kWaterFit.halvings && !better; ++half, step *= 0.5) {
      Water there = through(current + step);
      Weights at_step = this->weights(there, rows);
      better = cost(current + step, at_step) < before;
      if (better) {
        current += step;
        water = std::move(there);
        weights = std::move(at_step);
      }
    }
    if (!better || cost(current, weights) > (1.0 - kWaterFit.settled) * before) {
      break;
    }
  }
  return current;
}

Eigen::VectorXd CurrentFit::fitted(const Eigen::VectorXd& start) const {
  Rows all(static_cast<std::size_t>(x_.cols()));
  std::iota(all.begin(), all.end(), Eigen::Index{0});
  return descend(start, all);
}

Eigen::ArrayXXd CurrentFit::log_errors(const Eigen::VectorXd& start) const {
  Eigen::ArrayXXd logs(static_cast<Eigen::Index>(kFolds), y_.rows());
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    Rows fitted;
    Rows held;
    for (Eigen::Index row = 0; row < x_.cols(); ++row) {
      (fold_[static_cast<std::size_t>(row)] == fold ? held : fitted).push_back(row);
    }
    const Water water = through(descend(start, fitted));
    const Weights weights = this->weights(water, fitted);
    const Eigen::MatrixXd errors =
        water.y(Eigen::all, held) - weights.of.transpose() * water.phi(Eigen::all, held);
    const Eigen::ArrayXd square = errors.rowwise().squaredNorm().array() /
                                  static_cast<double>(std::max<std::size_t>(held.size(), 1));
    logs.row(static_cast<Eigen::Index>(fold)) =
        (square / variance_).max(kFoldFit.rounding).min(kFoldFit.error_cap).log().transpose();
  }
  return logs;
}

}  // namespace kelpie
