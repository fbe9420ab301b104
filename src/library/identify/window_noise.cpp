// SPDX-License-Identifier: Apache-2.0
#include "identify/window_noise.hpp"

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <limits>

#include "core/normal_equations.hpp"

namespace kelpie {
namespace {

constexpr int kGrid = 400;  // points of half a window, for the shapes below

using Shape = std::vector<double>;  // autocorrelation over lags of a stride

// Of a weight function with support [-1, 1], over lags in units of half a window.
template <typename Weight>
Shape autocorrelation(Weight weight, const WindowShape& window) {
  const auto lags = static_cast<std::size_t>(std::ceil(2.0 * window.half_s / window.stride_s));
  Shape shape;
  for (std::size_t lag = 0; lag < lags; ++lag) {
    const double shift = static_cast<double>(lag) * window.stride_s / window.half_s;
    double sum = 0.0;
    for (int i = -kGrid; i <= kGrid; ++i) {
      const double s = static_cast<double>(i) / kGrid;
      sum += s + shift <= 1.0 ? weight(s) * weight(s + shift) : 0.0;
    }
    shape.push_back(sum);
  }
  const double first = shape.front();
  for (double& value : shape) {
    value /= first;
  }
  return shape;
}

// V X with V the Toeplitz matrix of a shape.
Eigen::MatrixXd spread(const Shape& shape, const Eigen::MatrixXd& x) {
  Eigen::MatrixXd result = x;
  const Eigen::Index n = x.rows();
  for (std::size_t k = 1; k < shape.size() && static_cast<Eigen::Index>(k) < n; ++k) {
    const auto lag = static_cast<Eigen::Index>(k);
    result.bottomRows(n - lag) += shape[k] * x.topRows(n - lag);
    result.topRows(n - lag) += shape[k] * x.bottomRows(n - lag);
  }
  return result;
}

// tr(V W) of two Toeplitz matrices of n rows.
double trace(const Shape& v, const Shape& w, Eigen::Index n) {
  double sum = static_cast<double>(n) * v[0] * w[0];
  for (std::size_t k = 1; k < v.size() && static_cast<Eigen::Index>(k) < n; ++k) {
    sum += 2.0 * static_cast<double>(n - static_cast<Eigen::Index>(k)) * v[k] * w[k];
  }
  return sum;
}

// E[eᵀ V_i e] = Σ_j s_j tr(P V_i P V_j) for e = P a, P = I − F (FᵀF)⁻¹ Fᵀ.
Eigen::Matrix2d expectations(const std::array<Shape, 2>& shapes, const Eigen::MatrixXd& terms) {
  const Eigen::MatrixXd inverse = equilibrated_inverse(terms.transpose() * terms);
  std::array<Eigen::MatrixXd, 2> spreads;
  std::array<Eigen::MatrixXd, 2> inner;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    spreads[i] = spread(shapes[i], terms);
    inner[i] = inverse * (terms.transpose() * spreads[i]);
  }
  Eigen::Matrix2d matrix;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    for (std::size_t j = 0; j < shapes.size(); ++j) {
      matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          trace(shapes[i], shapes[j], terms.rows()) -
          2.0 * (inverse * (spreads[i].transpose() * spreads[j])).trace() +
          (inner[i] * inner[j]).trace();
    }
  }
  return matrix;
}

// Least squares with both variances ≥ 0.
Eigen::Vector2d variances(const Eigen::Matrix2d& matrix, const Eigen::Vector2d& found) {
  const double least = std::numeric_limits<double>::min();
  Eigen::Vector2d both = matrix.ldlt().solve(found);
  if (both.allFinite() && both.minCoeff() >= 0.0) {
    return both;
  }
  const Eigen::Vector2d alone =
      found.cwiseQuotient(matrix.diagonal().cwiseMax(least)).cwiseMax(0.0);
  // One alone: the one that leaves less of what was found.
  const double first = (found - alone(0) * matrix.col(0)).norm();
  const double second = (found - alone(1) * matrix.col(1)).norm();
  return first <= second ? Eigen::Vector2d(alone(0), 0.0) : Eigen::Vector2d(0.0, alone(1));
}

}  // namespace

WindowNoise window_noise(const WeakRows& rows, const FreeFit& fit, const WindowShape& shape) {
  const std::array<Shape, 2> shapes{
      autocorrelation([](double s) { return s * std::pow(1.0 - s * s, 2.0); }, shape),
      autocorrelation([](double s) { return std::pow(1.0 - s * s, 3.0); }, shape)};
  const Eigen::Matrix2d matrix = expectations(shapes, rows.terms);
  const Eigen::MatrixXd residuals = rows.acceleration - rows.terms * fit.coefficients;
  const Eigen::Index axes = residuals.cols();
  WindowNoise noise;
  noise.autocovariance.assign(shapes[0].size(), Eigen::VectorXd::Zero(axes));
  for (Eigen::Index axis = 0; axis < axes; ++axis) {
    const Eigen::VectorXd e = residuals.col(axis);
    const Eigen::Vector2d found(e.dot(spread(shapes[0], e).col(0)),
                                e.dot(spread(shapes[1], e).col(0)));
    const Eigen::Vector2d parts = variances(matrix, found);
    for (std::size_t lag = 0; lag < shapes[0].size(); ++lag) {
      noise.autocovariance[lag](axis) = parts(0) * shapes[0][lag] + parts(1) * shapes[1][lag];
    }
  }
  return noise;
}

std::vector<Eigen::MatrixXd> expected_axis_scores(const Eigen::MatrixXd& terms,
                                                  const WindowNoise& noise) {
  const Eigen::Index n = terms.rows();
  const Eigen::Index count = terms.cols();
  const Eigen::Index axes = noise.autocovariance.front().size();
  std::vector<Eigen::MatrixXd> scores(static_cast<std::size_t>(axes),
                                      Eigen::MatrixXd::Zero(count, count));
  for (std::size_t k = 0; k < noise.autocovariance.size() && static_cast<Eigen::Index>(k) < n;
       ++k) {
    const auto lag = static_cast<Eigen::Index>(k);
    Eigen::MatrixXd products = terms.bottomRows(n - lag).transpose() * terms.topRows(n - lag);
    if (lag > 0) {
      products = (products + products.transpose()).eval();
    }
    for (Eigen::Index axis = 0; axis < axes; ++axis) {
      scores[static_cast<std::size_t>(axis)] += noise.autocovariance[k](axis) * products;
    }
  }
  return scores;
}

Eigen::MatrixXd expected_scores(const Eigen::MatrixXd& terms, const WindowNoise& noise) {
  const std::vector<Eigen::MatrixXd> by_axis = expected_axis_scores(terms, noise);
  const Eigen::Index count = terms.cols();
  const auto axes = static_cast<Eigen::Index>(by_axis.size());
  Eigen::MatrixXd scores = Eigen::MatrixXd::Zero(axes * count, axes * count);
  for (Eigen::Index axis = 0; axis < axes; ++axis) {
    scores(Eigen::seqN(axis, count, axes), Eigen::seqN(axis, count, axes)) =
        by_axis[static_cast<std::size_t>(axis)];
  }
  return scores;
}

}  // namespace kelpie
