// SPDX-License-Identifier: Apache-2.0
#include "alignment/alignment_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "alignment/tuning.hpp"
#include "core/decomposition.hpp"
#include "core/quantile.hpp"
#include "core/seconds.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie {
namespace {

constexpr const auto& kFit = kAlignmentTuning.alignment;

Eigen::ArrayXd log_share(const Eigen::ArrayXd& error, const Eigen::ArrayXd& variance) {
  return (error / variance.max(kFit.least_variance)).max(kFit.rounding).min(kFit.error_cap).log();
}

struct TidyColumn {
  std::vector<double> values;  // within ±1
  double largest = 0.0;        // before the division
};

// A column of the rows in use, clipped to the range of most of the rows widened by half the range
// on either side, and divided by the largest value left.
TidyColumn tidy_column(std::span<const double> all, std::size_t column, std::size_t width,
                       std::span<const std::size_t> rows) {
  TidyColumn tidy;
  auto& [values, largest] = tidy;
  values.reserve(rows.size());
  for (const std::size_t row : rows) {
    values.push_back(all[row * width + column]);
  }
  std::vector<double> order = values;
  const double low = quantile(order, 0.01);
  const double high = quantile(order, 0.99);
  const double margin = 0.5 * high - 0.5 * low;
  for (double& value : values) {
    value = margin > 0.0 ? std::clamp(value, low - margin, high + margin) : value;
    largest = std::max(largest, std::abs(value));
  }
  largest = largest > 0.0 ? largest : 1.0;
  for (double& value : values) {
    value /= largest;
  }
  return tidy;
}

bool breaks(const AlignmentProblem& problem, std::size_t before, std::size_t after) {
  return static_cast<double>(after - before) > kLongestStep ||
         problem.times_s[after] - problem.times_s[before] > kLongestStep / problem.rate_hz ||
         (!problem.configurations.empty() &&
          problem.configurations[after] != problem.configurations[before]);
}

}  // namespace

AlignmentRows::AlignmentRows(const AlignmentProblem& problem)
    : rows_(problem.rows), times_s_(problem.times_s), rate_hz_(problem.rate_hz) {
  if (!(problem.rate_hz > 0.0)) {
    throw InputError("rate", "has to be > 0 rows per second");
  }
  const std::size_t width = problem.input_names.size();
  largest.resize(width);
  for (std::size_t i = 0; i < width; ++i) {
    TidyColumn tidy = tidy_column(problem.inputs, i, width, rows_);
    inputs.push_back(std::move(tidy.values));
    largest[i] = tidy.largest;
  }
  for (std::size_t i = 0; i < problem.target_count; ++i) {
    TidyColumn tidy = tidy_column(problem.targets, i, problem.target_count, rows_);
    targets.push_back(std::move(tidy.values));
    largest_target.push_back(tidy.largest);
  }
  first_.resize(size());
  last_.resize(size());
  for (std::size_t i = 1; i < size(); ++i) {
    first_[i] = breaks(problem, rows_[i - 1], rows_[i]) ? i : first_[i - 1];
  }
  for (std::size_t i = size(); i-- > 0;) {
    last_[i] = i + 1 == size() || first_[i + 1] == i + 1 ? i : last_[i + 1];
  }
}

std::size_t AlignmentRows::shifted(std::size_t i, int shift) const {
  const auto wanted = static_cast<std::ptrdiff_t>(rows_[i]) + shift;
  std::size_t at = i;
  if (shift > 0) {
    while (at < last_[i] && static_cast<std::ptrdiff_t>(rows_[at]) < wanted) {
      ++at;
    }
  } else {
    while (at > first_[i] && static_cast<std::ptrdiff_t>(rows_[at]) > wanted) {
      --at;
    }
  }
  return at;
}

double AlignmentRows::duration_s() const {
  double sum = 0.0;
  for (std::size_t i = 0; i < size(); ++i) {
    sum += i > first_[i] ? times_s_[rows_[i]] - times_s_[rows_[i - 1]] : 0.0;
  }
  return sum;
}

void AlignmentRows::effects(std::size_t command, int shift, const Actuator& actuator,
                            std::span<double> effects) const {
  const double scale = largest[command];
  ActuatorState state(actuator, rate_hz_);
  for (std::size_t i = 0; i < size(); ++i) {
    if (i == first_[i]) {
      state.rest();
    }
    const double given = inputs[command][shifted(i, shift)];
    effects[i] = actuator.none() ? given : state.next(given * scale, times_s_[rows_[i]]) / scale;
  }
}

AlignmentGuess AlignmentGuess::of(const Alignment& alignment, std::size_t commands) {
  AlignmentGuess guess{.shift = alignment.rows, .actuators = alignment.actuators};
  guess.actuators.resize(commands);
  return guess;
}

AlignmentFit::AlignmentFit(const AlignmentRows& rows, const std::vector<std::size_t>& commands)
    : rows_(rows), every_(1 + (rows.size() - 1) / kFit.most_fitted_rows) {
  for (std::size_t i = 0; i < rows.inputs.size(); ++i) {
    (std::ranges::find(commands, i) == commands.end() ? states_ : commands_).push_back(i);
  }
  for (const std::size_t command : commands_) {
    effects_.push_back({.values = rows.inputs[command]});
  }
  list_ = MotionTerms::alignment(rows.inputs.size(), states_);
}

void AlignmentFit::take(const AlignmentGuess& guess) {
  for (std::size_t k = 0; k < commands_.size(); ++k) {
    Effect& effect = effects_[k];
    if (effect.shift != guess.shift || effect.actuator != guess.actuators[k]) {
      effect.shift = guess.shift;
      effect.actuator = guess.actuators[k];
      rows_.effects(commands_[k], guess.shift, guess.actuators[k], effect.values);
    }
  }
}

AlignmentFit::HeldOut AlignmentFit::held_out() const {
  std::vector<NormalEquations> folds;
  NormalEquations all(terms(), rows_.targets.size());
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    folds.push_back(sums_of(fold));
    all.add(folds.back());
  }
  // The last term is 1, so its row of sums tells the mean.
  const Eigen::ArrayXd mean = all.moments().row(all.moments().rows() - 1).transpose() / all.rows();
  const Eigen::VectorXd scale = (all.gram().diagonal().array() > 0.0)
                                    .select(all.gram().diagonal().array() / all.rows(), 1.0)
                                    .matrix();
  HeldOut held_out{.coefficients = {},
                   .errors{static_cast<Eigen::Index>(kFolds), mean.size()},
                   .variance = all.squares().diagonal().array() / all.rows() - mean.square()};
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    NormalEquations fitted = all;
    fitted.subtract(folds[fold]);
    held_out.coefficients.push_back(fitted.solve(kFit.unit_ridge * scale));
    held_out.errors.row(static_cast<Eigen::Index>(fold)) =
        (folds[fold].squared_errors(held_out.coefficients.back()) / folds[fold].rows()).transpose();
  }
  return held_out;
}

Eigen::ArrayXXd AlignmentFit::log_errors(const AlignmentGuess& guess) {
  take(guess);
  HeldOut held_out = this->held_out();
  for (auto errors : held_out.errors.rowwise()) {
    errors = log_share(errors.transpose(), held_out.variance).transpose();
  }
  return std::move(held_out.errors);
}

std::vector<std::size_t> AlignmentFit::explained_rows(const AlignmentGuess& guess) {
  take(guess);
  HeldOut held_out = this->held_out();
  for (auto errors : held_out.errors.colwise()) {
    std::ranges::sort(errors);
  }
  const Eigen::ArrayXd most = kFit.unexplained * held_out.errors.row(kFolds / 2).sqrt().transpose();
  std::vector<std::size_t> explained;
  std::vector<double> x(rows_.inputs.size());
  Eigen::VectorXd phi(static_cast<Eigen::Index>(terms()));
  Eigen::ArrayXd y(most.size());
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    const std::size_t end = rows_.size() * (fold + 1) / kFolds;
    for (std::size_t i = rows_.size() * fold / kFolds; i < end; ++i) {
      fill(i, x, phi);
      for (Eigen::Index k = 0; k < y.size(); ++k) {
        y[k] = rows_.targets[static_cast<std::size_t>(k)][i];
      }
      const Eigen::ArrayXd miss = y - (held_out.coefficients[fold].transpose() * phi).array();
      if ((miss.abs() <= most).all()) {
        explained.push_back(rows_.row(i));
      }
    }
  }
  return explained;
}

Eigen::ArrayXXd AlignmentFit::log_kernel_errors(const AlignmentGuess& guess) {
  take(guess);
  Eigen::ArrayXXd errors(static_cast<Eigen::Index>(kParts), 1);
  for (std::size_t part = 0; part < kParts; ++part) {
    std::vector<std::size_t> rows;
    const std::size_t begin = rows_.size() * part / kParts;
    const std::size_t size = rows_.size() * (part + 1) / kParts - begin;
    const std::size_t count = std::min(size, kFit.kernel_rows);
    for (std::size_t i = 0; i < count; ++i) {
      rows.push_back(begin + i * size / count);
    }
    errors(static_cast<Eigen::Index>(part), 0) = log_kernel_error(rows);
  }
  return errors;
}

double AlignmentFit::log_kernel_error(std::span<const std::size_t> rows) const {
  const auto count = static_cast<Eigen::Index>(rows.size());
  const auto folds = static_cast<Eigen::Index>(kParts);
  const Eigen::MatrixXd kernel = kernel_of(rows);
  Eigen::MatrixXd y(count, static_cast<Eigen::Index>(rows_.targets.size()));
  for (Eigen::Index i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < rows_.targets.size(); ++k) {
      y(i, static_cast<Eigen::Index>(k)) = rows_.targets[k][rows[static_cast<std::size_t>(i)]];
    }
  }
  y.rowwise() -= y.colwise().mean().eval();
  const Eigen::ArrayXd variance = y.colwise().squaredNorm() / static_cast<double>(count);
  double sum = 0.0;
  for (Eigen::Index fold = 0; fold < folds; ++fold) {
    std::vector<Eigen::Index> held;
    std::vector<Eigen::Index> fitted;
    for (Eigen::Index i = 0; i < count; ++i) {
      (i * folds / count == fold ? held : fitted).push_back(i);
    }
    Eigen::MatrixXd fit = kernel(fitted, fitted);
    fit.diagonal().array() += kFit.kernel_ridge;
    const Eigen::MatrixXd miss =
        y(held, Eigen::all) -
        kernel(held, fitted) * solve_symmetric(fit, Eigen::MatrixXd(y(fitted, Eigen::all)));
    const Eigen::ArrayXd error = miss.colwise().squaredNorm() / static_cast<double>(held.size());
    sum += log_share(error, variance).mean();
  }
  return sum / static_cast<double>(kParts);
}

// Squared exponential of the standardised inputs, and products of the terms.
Eigen::MatrixXd AlignmentFit::kernel_of(std::span<const std::size_t> rows) const {
  const auto count = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd x(static_cast<Eigen::Index>(rows_.inputs.size()), count);
  Eigen::MatrixXd phi(static_cast<Eigen::Index>(terms()), count);
  std::vector<double> at_row(rows_.inputs.size());
  for (Eigen::Index i = 0; i < count; ++i) {
    const std::size_t row = rows[static_cast<std::size_t>(i)];
    fill(row, at_row, phi.col(i));
    x.col(i) = as_vector(at_row);
  }
  x.colwise() -= x.rowwise().mean().eval();
  const auto to_unit = [&](Eigen::MatrixXd& values) {
    const Eigen::ArrayXd size =
        (values.rowwise().squaredNorm().array() / static_cast<double>(count)).sqrt();
    values.array().colwise() /= (size > 0.0).select(size, 1.0);
  };
  to_unit(x);
  to_unit(phi);
  const Eigen::VectorXd length = x.colwise().squaredNorm().transpose();
  Eigen::MatrixXd distance = -2.0 * x.transpose() * x;
  distance.colwise() += length;
  distance.rowwise() += length.transpose();
  return (-kFit.kernel_gamma * distance.array()).exp().matrix() +
         kFit.kernel_terms * phi.transpose() * phi;
}

NormalEquations AlignmentFit::sums_of(std::size_t fold) const {
  constexpr Eigen::Index kAtOnce = 256;
  NormalEquations sums(terms(), rows_.targets.size());
  Eigen::MatrixXd phi(static_cast<Eigen::Index>(terms()), kAtOnce);
  Eigen::MatrixXd y(static_cast<Eigen::Index>(rows_.targets.size()), kAtOnce);
  std::vector<double> x(rows_.inputs.size());
  Eigen::Index filled = 0;
  const std::size_t end = rows_.size() * (fold + 1) / kFolds;
  for (std::size_t row = rows_.size() * fold / kFolds; row < end; row += every_) {
    fill(row, x, phi.col(filled));
    for (std::size_t i = 0; i < rows_.targets.size(); ++i) {
      y(static_cast<Eigen::Index>(i), filled) = rows_.targets[i][row];
    }
    if (++filled == kAtOnce) {
      sums.add_block(phi, y);
      filled = 0;
    }
  }
  sums.add_block(phi.leftCols(filled), y.leftCols(filled));
  return sums;
}

void AlignmentFit::fill(std::size_t row, std::span<double> x,
                        Eigen::Ref<Eigen::VectorXd> phi) const {
  for (const std::size_t state : states_) {
    x[state] = rows_.inputs[state][row];
  }
  for (std::size_t k = 0; k < commands_.size(); ++k) {
    x[commands_[k]] = effects_[k].values[row];
  }
  list_.evaluate(x, std::span(phi.data(), terms()));
}

}  // namespace kelpie
