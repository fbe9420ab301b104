// SPDX-License-Identifier: Apache-2.0
#include "health/glide_fit.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/eigen.hpp"
#include "health/tuning.hpp"
#include "identify/free_fit.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::health {
namespace {

double path_angle(double pitch, double attack) {
  double alpha = 0.0;
  for (int round = 0; round < kGlide.attack_rounds; ++round) {
    double slope = std::tan(pitch + alpha);
    slope = std::copysign(std::max(std::abs(slope), kGlide.least_slope), slope);
    const double wanted = (attack + kGlide.induced * alpha * alpha) / slope;
    alpha = 0.5 * (alpha + std::clamp(wanted, -kGlide.most_attack_rad, kGlide.most_attack_rad));
  }
  return pitch + alpha;
}

// Speed through the water and sinking of a glider that has settled.
std::pair<double, double> settled(const GlideRows& rows, std::size_t i, const GlideParameters& p) {
  const double sine = std::sin(path_angle(rows.pitch_rad[i], p[GlidePlace::attack]));
  double buoyancy =
      rows.ballast_ml[i] + p[GlidePlace::buoyancy] + p[GlidePlace::depth] * rows.depth_m[i];
  if (!rows.density.empty()) {
    buoyancy += p[GlidePlace::density] * (rows.density[i] - kGlide.reference_density);
  }
  const double speed = std::sqrt(std::abs(buoyancy * sine) / std::max(p[GlidePlace::drag], 1e-6));
  return {speed, -std::copysign(speed * std::abs(sine), buoyancy)};
}

// Measured less predicted speeds of all parts, one below the other; speeds that are not measured
// are left out.
Eigen::VectorXd residuals(std::span<const GlideRows> parts, const GlideParameters& parameters) {
  std::vector<double> values;
  for (const GlideRows& rows : parts) {
    const GlideMotion motion = glide(rows, parameters);
    for (std::size_t i = 0; i < rows.rows(); ++i) {
      if (!rows.sinking.empty() && std::isfinite(rows.sinking[i])) {
        values.push_back(rows.sinking[i] - motion.sinking[i]);
      }
      if (!rows.speed.empty() && std::isfinite(rows.speed[i])) {
        values.push_back(rows.speed[i] - motion.speed[i]);
      }
    }
  }
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

// The linear problem of a step, in units of the steps of the derivatives.
WeakRows step_rows(std::span<const GlideRows> parts, const GlideParameters& parameters,
                   std::span<const std::size_t> free) {
  const Eigen::VectorXd rest = residuals(parts, parameters);
  WeakRows rows{rest, Eigen::MatrixXd(rest.size(), static_cast<Eigen::Index>(free.size())), {}};
  for (std::size_t k = 0; k < free.size(); ++k) {
    GlideParameters moved = parameters;
    moved[free[k]] += kGlide.step[free[k]];
    rows.terms.col(static_cast<Eigen::Index>(k)) = rest - residuals(parts, moved);
  }
  return rows;
}

GlideParameters moved_by(GlideParameters parameters, std::span<const std::size_t> free,
                         const Eigen::VectorXd& step, double share) {
  for (std::size_t k = 0; k < free.size(); ++k) {
    parameters[free[k]] += share * kGlide.step[free[k]] * step(static_cast<Eigen::Index>(k));
  }
  parameters[GlidePlace::drag] = std::max(parameters[GlidePlace::drag], 1.0);
  parameters[GlidePlace::attack] = std::clamp(parameters[GlidePlace::attack], 0.0, 0.2);
  parameters[GlidePlace::lag] = std::max(parameters[GlidePlace::lag], 0.0);
  return parameters;
}

// Less than squares far out, as the weights of the fit.
double robust_squares(const Eigen::VectorXd& values, double usual) {
  const Eigen::ArrayXd sizes = values.array().abs() / usual;
  const double limit = kIdentification.huber_sigmas;
  return (sizes < limit).select(sizes.square(), 2.0 * limit * sizes - limit * limit).sum();
}

}  // namespace

GlideMotion glide(const GlideRows& rows, const GlideParameters& parameters) {
  GlideMotion motion;
  std::pair<double, double> last{};
  for (std::size_t i = 0; i < rows.rows(); ++i) {
    const double step_s = i > 0 ? std::max(rows.times_s[i] - rows.times_s[i - 1], 1e-3) : 1.0;
    const double fastest_rise = -std::max(0.0, rows.depth_m[i] - rows.surface_m) / step_s;
    std::pair<double, double> now = settled(rows, i, parameters);
    now.second = std::max(now.second, fastest_rise);
    auto [speed, sinking] = now;
    if (i > 0) {
      const double lag_s = parameters[GlidePlace::lag];
      const double kept = lag_s > 0.0 ? std::exp(-step_s / lag_s) : 0.0;
      const auto follow = [&](double before, double from, double to) {
        return kept * before + (1.0 - kept) * 0.5 * (from + to);
      };
      speed = follow(motion.speed.back(), last.first, speed);
      sinking = std::max(follow(motion.sinking.back(), last.second, sinking), fastest_rise);
    }
    last = now;
    motion.speed.push_back(speed);
    motion.sinking.push_back(sinking);
  }
  return motion;
}

GlideParameters first_glide() {
  return {0.0, 0.0, 0.0, 625.0, 0.01, 10.0};
}

GlideFit fit_glide(std::span<const GlideRows> parts, const GlideParameters& start,
                   std::span<const std::size_t> free) {
  GlideFit fit{.parameters = start};
  WeakRows rows = step_rows(parts, start, free);
  fit.rows = static_cast<std::size_t>(rows.terms.rows());
  if (rows.terms.rows() <= 2 * kIdentification.pieces) {
    throw InputError("too few rows with a vertical speed or a speed through the water: " +
                     std::to_string(fit.rows) + ", more than " +
                     std::to_string(2 * kIdentification.pieces) + " are needed");
  }
  FreeFit linear;
  for (int round = 0; round < kGlide.rounds; ++round) {
    linear = fit_freely(rows, kIdentification.pieces);
    const double usual = std::sqrt(linear.noise(0, 0));
    const double before = robust_squares(rows.acceleration.col(0), usual);
    double share = 1.0;
    GlideParameters next = moved_by(fit.parameters, free, linear.coefficients.col(0), share);
    double after = robust_squares(residuals(parts, next), usual);
    while (after > before && share > 1e-3) {
      share *= 0.5;
      next = moved_by(fit.parameters, free, linear.coefficients.col(0), share);
      after = robust_squares(residuals(parts, next), usual);
    }
    if (after > before) {
      break;
    }
    fit.parameters = next;
    rows = step_rows(parts, fit.parameters, free);
    if (before - after < kGlide.least_gain * before) {
      break;
    }
  }
  linear = fit_freely(rows, kIdentification.pieces);
  const Eigen::VectorXd errors = sandwich_errors(linear);
  for (std::size_t k = 0; k < free.size(); ++k) {
    fit.errors[free[k]] = kGlide.step[free[k]] * errors(static_cast<Eigen::Index>(k));
  }
  return fit;
}

std::pair<double, double> fit_slope(std::span<const double> x, std::span<const double> y) {
  const WeakRows rows{as_vector(y), as_vector(x), {}};
  if (rows.terms.rows() < 2 * kIdentification.pieces || !(rows.terms.squaredNorm() > 0.0)) {
    return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
  }
  const FreeFit fit = fit_freely(rows, kIdentification.pieces);
  return {fit.coefficients(0, 0), sandwich_errors(fit)(0)};
}

}  // namespace kelpie::health
