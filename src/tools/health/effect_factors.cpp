// SPDX-License-Identifier: Apache-2.0
#include "health/effect_factors.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/eigen.hpp"
#include "health/tuning.hpp"
#include "identify/free_fit.hpp"
#include "identify/weak_form.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/motion/attitude.hpp"
#include "motion/motion_terms.hpp"

namespace kelpie::health {
namespace {

// A drive in the weak form; the last term is a constant.
struct DriveWindows {
  WeakRows weak;
  Eigen::VectorXd volts;  // means of the windows
  Eigen::VectorXd density;
};

DriveWindows windows_of(const DriveRows& drive, const MotionTerms& terms, std::size_t inputs,
                        double gap_s) {
  const std::size_t count = drive.times_s.size();
  const auto size = static_cast<Eigen::Index>(terms.size());
  const std::vector<std::size_t>& velocities = terms.velocities();
  std::vector<std::size_t> starts;
  EquationRows rows{.times_s = drive.times_s,
                    .starts = {},
                    .velocities = Eigen::MatrixXd(static_cast<Eigen::Index>(count),
                                                  static_cast<Eigen::Index>(velocities.size())),
                    .terms = Eigen::MatrixXd(static_cast<Eigen::Index>(count), size + 3)};
  std::vector<double> values(terms.size());
  for (std::size_t i = 0; i < count; ++i) {
    if (i == 0 || drive.times_s[i] - drive.times_s[i - 1] > gap_s) {
      starts.push_back(i);
    }
    const auto row = static_cast<Eigen::Index>(i);
    const std::span x = std::span(drive.inputs).subspan(i * inputs, inputs);
    terms.evaluate(x, values);
    rows.terms.row(row).head(size) = as_vector(values).transpose();
    rows.terms.row(row).tail(3) << 1.0, drive.volts.empty() ? 1.0 : drive.volts[i],
        drive.density.empty() ? 1.0 : drive.density[i];
    for (std::size_t k = 0; k < velocities.size(); ++k) {
      rows.velocities(row, static_cast<Eigen::Index>(k)) = x[velocities[k]];
    }
  }
  rows.starts = starts;
  DriveWindows windows{.weak = weak_rows(rows, kPlanarWindow), .volts = {}, .density = {}};
  windows.volts = windows.weak.terms.col(size + 1);
  windows.density = windows.weak.terms.col(size + 2);
  windows.weak.terms.conservativeResize(Eigen::NoChange, size + 1);
  return windows;
}

// The terms of an effect, with their axes; the constant is the last term.
using Members = std::vector<std::pair<Eigen::Index, Eigen::Index>>;

Members members_of(const Effect& effect, const MotionTerms& terms) {
  const std::vector<std::size_t>& velocities = terms.velocities();
  const auto size = static_cast<Eigen::Index>(terms.size());
  const auto own = std::ranges::find(velocities, effect.input) - velocities.begin();
  if (effect.kind == EffectKind::constant) {
    return {{size, own}};
  }
  Members members;
  for (Eigen::Index term = 0; term < size; ++term) {
    const MotionTerm& one = terms[static_cast<std::size_t>(term)];
    if (effect.kind == EffectKind::damping && one.damps(effect.input)) {
      members.emplace_back(term, own);
    } else if (effect.kind == EffectKind::command && one.a == effect.input) {
      for (std::size_t axis = 0; axis < velocities.size(); ++axis) {
        members.emplace_back(term, static_cast<Eigen::Index>(axis));
      }
    }
  }
  return members;
}

std::vector<Effect> effects_of(const MotionTerms& terms) {
  std::vector<Effect> effects;
  for (const std::size_t velocity : terms.velocities()) {
    effects.push_back({EffectKind::damping, velocity});
  }
  for (const std::size_t command : terms.commands()) {
    effects.push_back({EffectKind::command, command});
  }
  for (const std::size_t velocity : terms.velocities()) {
    effects.push_back({EffectKind::constant, velocity});
  }
  return effects;
}

Eigen::Index window_count(const std::vector<DriveWindows>& drives) {
  Eigen::Index count = 0;
  for (const DriveWindows& drive : drives) {
    count += drive.weak.terms.rows();
  }
  return count;
}

// The windows of all drives, evenly thinned.
WeakRows pooled(const std::vector<DriveWindows>& drives) {
  const Eigen::Index all = window_count(drives);
  const Eigen::Index every = 1 + (all - 1) / kFactors.most_windows;
  const Eigen::Index count = (all + every - 1) / every;
  WeakRows rows{Eigen::MatrixXd(count, drives.front().weak.acceleration.cols()),
                Eigen::MatrixXd(count, drives.front().weak.terms.cols()),
                {}};
  Eigen::Index seen = 0;
  for (const DriveWindows& drive : drives) {
    for (Eigen::Index row = 0; row < drive.weak.terms.rows(); ++row, ++seen) {
      if (seen % every == 0) {
        rows.acceleration.row(seen / every) = drive.weak.acceleration.row(row);
        rows.terms.row(seen / every) = drive.weak.terms.row(row);
      }
    }
  }
  return rows;
}

// Terms of commands times (volts / reference)^exponent.
void apply_volts(std::vector<DriveWindows>& drives, const MotionTerms& terms, double reference,
                 double exponent) {
  const std::vector<std::size_t>& commands = terms.commands();
  for (DriveWindows& drive : drives) {
    const Eigen::ArrayXd factor = (drive.volts.array() / reference).pow(exponent);
    for (std::size_t term = 0; term < terms.size(); ++term) {
      if (std::ranges::find(commands, terms[term].a) != commands.end()) {
        drive.weak.terms.col(static_cast<Eigen::Index>(term)).array() *= factor;
      }
    }
  }
}

// The exponent with the least errors of the common fit.
double find_exponent(const std::vector<DriveWindows>& drives, const MotionTerms& terms,
                     double reference) {
  double best = 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (double exponent = 0.0; exponent <= kFactors.most_exponent;
       exponent += kFactors.exponent_step) {
    std::vector<DriveWindows> tried = drives;
    apply_volts(tried, terms, reference, exponent);
    const double errors =
        fit_freely(pooled(tried), kIdentification.pieces).noise.diagonal().array().log().sum();
    if (errors < least) {
      least = errors;
      best = exponent;
    }
  }
  return best;
}

std::pair<double, double> range_of(const std::vector<DriveWindows>& drives,
                                   Eigen::VectorXd DriveWindows::*of) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const DriveWindows& drive : drives) {
    if ((drive.*of).size() > 0) {
      low = std::min(low, (drive.*of).minCoeff());
      high = std::max(high, (drive.*of).maxCoeff());
    }
  }
  return {low, high};
}

// Takes the effects of density and supply off the terms.
void take_off_slow(std::vector<DriveWindows>& drives, const MotionTerms& terms,
                   EffectFactors& found) {
  found.density = range_of(drives, &DriveWindows::density);
  const auto size = static_cast<Eigen::Index>(terms.size());
  for (DriveWindows& drive : drives) {
    const Eigen::VectorXd factor =
        drive.density * (2.0 / (found.density.first + found.density.second));
    drive.weak.terms.leftCols(size) = factor.asDiagonal() * drive.weak.terms.leftCols(size);
  }
  found.volts = range_of(drives, &DriveWindows::volts);
  const auto [low, high] = found.volts;
  if (low > 0.0 && high / low >= kIdentification.least_volts_ratio) {
    found.exponent = find_exponent(drives, terms, 0.5 * (low + high));
    apply_volts(drives, terms, 0.5 * (low + high), *found.exponent);
  }
}

// The factors of a drive: the axes of a window stand below each other, each over the usual error.
WeakRows factor_rows(const WeakRows& rows, const FreeFit& common,
                     const std::vector<Effect>& effects, const MotionTerms& terms) {
  const Eigen::Index axes = rows.acceleration.cols();
  const Eigen::Index count = rows.terms.rows();
  const Eigen::VectorXd usual = common.noise.diagonal().cwiseSqrt();
  Eigen::MatrixXd held = common.coefficients;
  WeakRows stacked{Eigen::MatrixXd::Zero(count * axes, 1),
                   Eigen::MatrixXd::Zero(count * axes, static_cast<Eigen::Index>(effects.size())),
                   {}};
  for (std::size_t i = 0; i < effects.size(); ++i) {
    for (const auto& [term, axis] : members_of(effects[i], terms)) {
      const double size =
          effects[i].kind == EffectKind::constant ? 1.0 : common.coefficients(term, axis);
      stacked.terms(Eigen::seqN(axis, count, axes), static_cast<Eigen::Index>(i)) +=
          size / usual(axis) * rows.terms.col(term);
      held(term, axis) = 0.0;
    }
  }
  const Eigen::MatrixXd rest = rows.acceleration - rows.terms * held;
  for (Eigen::Index axis = 0; axis < axes; ++axis) {
    stacked.acceleration(Eigen::seqN(axis, count, axes), 0) = rest.col(axis) / usual(axis);
  }
  return stacked;
}

std::vector<EffectFactor> factors_of(const WeakRows& rows, const FreeFit& common,
                                     const std::vector<Effect>& effects, const MotionTerms& terms) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<EffectFactor> factors(effects.size(), {nan, nan});
  if (rows.terms.rows() < static_cast<Eigen::Index>(kFewestFactorWindows)) {
    return factors;
  }
  const FreeFit fit = fit_freely(factor_rows(rows, common, effects, terms), kIdentification.pieces);
  const Eigen::VectorXd errors = sandwich_errors(fit);
  for (std::size_t i = 0; i < effects.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const bool is_told =
        fit.gram(at, at) > 0.0 && errors(at) > 0.0 && std::isfinite(errors(at)) &&
        (effects[i].kind == EffectKind::constant || errors(at) < kFactors.most_error);
    if (is_told) {
      factors[i] = {fit.coefficients(at, 0), errors(at)};
    }
  }
  return factors;
}

}  // namespace

EffectFactors fit_factors(std::span<const DriveRows> drives, std::span<const std::string> names,
                          std::span<const std::size_t> velocities, double gap_s) {
  const MotionTerms terms = MotionTerms::open_loop(names.size(), velocities, kFactors.most_terms,
                                                   attitude_for("auto", names));
  std::vector<DriveWindows> windows;
  for (const DriveRows& drive : drives) {
    windows.push_back(windows_of(drive, terms, names.size(), gap_s));
  }
  const Eigen::Index count = window_count(windows);
  const Eigen::Index needed =
      kFactors.windows_per_term * static_cast<Eigen::Index>(terms.size() + 1);
  if (count < needed) {
    throw InputError("too few rows: " + std::to_string(count) +
                     " windows of 5 s without a gap in all drives, " + std::to_string(needed) +
                     " are needed");
  }
  EffectFactors found{.effects = effects_of(terms), .drives = {}};
  take_off_slow(windows, terms, found);
  const FreeFit common = fit_freely(pooled(windows), kIdentification.pieces);
  for (const DriveWindows& drive : windows) {
    found.drives.push_back(factors_of(drive.weak, common, found.effects, terms));
  }
  return found;
}

}  // namespace kelpie::health
