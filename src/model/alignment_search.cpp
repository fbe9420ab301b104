// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/alignment_search.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "kelpie/core/setting.hpp"
#include "kelpie/model/alignment_rows.hpp"
#include "kelpie/physics/states.hpp"

namespace kelpie {
namespace {

constexpr double kFarthestS = 1.0;
constexpr int kStepsPerSide = 10;
constexpr std::size_t kFolds = 5;
constexpr std::size_t kMostRows = 20'000;
constexpr std::size_t kRowsPerCoefficient = 10;
constexpr double kLeastGain = 0.03;    // mean of logarithms
constexpr double kGainingShare = 0.6;  // of folds and targets that gain
constexpr double kRounding = 1e-6;     // of a target's variance: less is rounding
constexpr double kErrorCap = 1.5;
constexpr double kLeastVariance = 1e-12;  // of a target whose largest value is 1
constexpr double kUnitRidge = 1.0;        // against sums over rows with unit mean square
constexpr std::size_t kKernelRows = 300;
constexpr double kKernelGamma = 0.15;
constexpr double kKernelTerms = 0.05;
constexpr double kKernelRidge = 0.01;
constexpr double kSlopeCorrelation = 0.5;

double correlation_between(const Eigen::ArrayXd& a, const Eigen::ArrayXd& b) {
  const Eigen::ArrayXd da = a - a.mean();
  const Eigen::ArrayXd db = b - b.mean();
  const double both = std::sqrt(da.square().sum() * db.square().sum());
  return both > 0.0 ? (da * db).sum() / both : 0.0;
}

// For each target the input whose slope over half a second goes with it best. None unless every
// target has one of its own.
std::vector<std::size_t> accelerated_inputs(const AlignmentProblem& problem,
                                            const AlignmentRows& rows) {
  const int reach = std::max(1, static_cast<int>(std::lround(0.25 * problem.rate_hz)));
  const auto size = static_cast<Eigen::Index>(rows.size());
  std::vector<std::size_t> best(rows.targets.size());
  std::vector<double> most(rows.targets.size(), kSlopeCorrelation);
  Eigen::ArrayXd rise(size);
  for (std::size_t i = 0; i < rows.inputs.size(); ++i) {
    for (Eigen::Index at = 0; at < size; ++at) {
      const auto row = static_cast<std::size_t>(at);
      rise[at] =
          rows.inputs[i][rows.shifted(row, reach)] - rows.inputs[i][rows.shifted(row, -reach)];
    }
    for (std::size_t target = 0; target < best.size(); ++target) {
      const double found = correlation_between(
          rise, Eigen::Map<const Eigen::ArrayXd>(rows.targets[target].data(), size));
      if (found > most[target]) {
        most[target] = found;
        best[target] = i;
      }
    }
  }
  std::ranges::sort(best);
  const bool all = std::ranges::none_of(most, [](double c) { return c == kSlopeCorrelation; }) &&
                   std::ranges::adjacent_find(best) == best.end();
  return all ? best : std::vector<std::size_t>{};
}

std::vector<std::size_t> commands_of(const AlignmentProblem& problem, const AlignmentRows& rows) {
  std::vector<std::size_t> states =
      find_states(problem.states, problem.input_names, problem.target_count);
  if (states.empty()) {
    states.resize(named_velocities(problem.input_names));
    std::iota(states.begin(), states.end(), std::size_t{0});
  }
  if (states.empty()) {
    states = accelerated_inputs(problem, rows);
  }
  std::vector<std::size_t> commands;
  for (std::size_t i = 0; i < problem.input_names.size() && !states.empty(); ++i) {
    if (std::ranges::find(states, i) == states.end()) {
      commands.push_back(i);
    }
  }
  return commands;
}

// Cross-validated least squares with commands shifted.
class ShiftedFit {
 public:
  ShiftedFit(const AlignmentRows& rows, const std::vector<std::size_t>& commands)
      : rows_(rows), every_(1 + (rows.size() - 1) / kMostRows) {
    for (std::size_t i = 0; i < rows.inputs.size(); ++i) {
      (std::ranges::find(commands, i) == commands.end() ? states_ : commands_).push_back(i);
    }
    const std::size_t v = states_.size();
    terms_ = 2 * rows.inputs.size() + v * (v - 1) / 2 + 1;
  }

  std::size_t terms() const { return terms_; }

  // Error of each fold and target over the target's variance, in logarithms.
  Eigen::ArrayXXd log_errors(int shift) const {
    std::array<Normal, kFolds> folds;
    Normal all = empty();
    for (std::size_t fold = 0; fold < kFolds; ++fold) {
      folds[fold] = normal_of(fold, shift);
      all.design += folds[fold].design;
      all.answer += folds[fold].answer;
      all.squares += folds[fold].squares;
      all.rows += folds[fold].rows;
    }
    // The last term is 1, so its row of sums tells the mean.
    const Eigen::ArrayXd mean = all.answer.row(all.answer.rows() - 1).transpose() / all.rows;
    const Eigen::ArrayXd variance = all.squares.array() / all.rows - mean.square();
    const Eigen::VectorXd scale = (all.design.diagonal().array() > 0.0)
                                      .select(all.design.diagonal().array() / all.rows, 1.0)
                                      .matrix();
    Eigen::ArrayXXd logs(static_cast<Eigen::Index>(kFolds), mean.size());
    for (std::size_t fold = 0; fold < kFolds; ++fold) {
      const Normal& held = folds[fold];
      Eigen::MatrixXd design = all.design - held.design;
      design.diagonal() += kUnitRidge * scale;
      const Eigen::MatrixXd weights = design.ldlt().solve(all.answer - held.answer);
      const Eigen::ArrayXd error =
          (held.squares -
           2.0 * (weights.array() * held.answer.array()).colwise().sum().matrix().transpose() +
           (weights.array() * (held.design * weights).array()).colwise().sum().matrix().transpose())
              .array() /
          held.rows;
      logs.row(static_cast<Eigen::Index>(fold)) = log_share(error, variance).transpose();
    }
    return logs;
  }

  // Mean of the same by kernel ridge regression, which can follow what no term describes, on a few
  // rows of each fifth of the log: a vehicle that changes on the way can't blur it.
  double log_kernel_error(int shift) const {
    double sum = 0.0;
    for (std::size_t part = 0; part < kFolds; ++part) {
      std::vector<std::size_t> rows;
      const std::size_t begin = rows_.size() * part / kFolds;
      const std::size_t size = rows_.size() * (part + 1) / kFolds - begin;
      const std::size_t count = std::min(size, kKernelRows);
      for (std::size_t i = 0; i < count; ++i) {
        rows.push_back(begin + i * size / count);
      }
      sum += log_kernel_error(rows, shift);
    }
    return sum / static_cast<double>(kFolds);
  }

 private:
  // Sums over the rows of a fold: φφᵀ, φy, y².
  struct Normal {
    Eigen::MatrixXd design;
    Eigen::MatrixXd answer;
    Eigen::VectorXd squares;
    double rows = 0.0;
  };

  static Eigen::ArrayXd log_share(const Eigen::ArrayXd& error, const Eigen::ArrayXd& variance) {
    return (error / variance.max(kLeastVariance)).max(kRounding).min(kErrorCap).log();
  }

  double log_kernel_error(std::span<const std::size_t> rows, int shift) const {
    const auto count = static_cast<Eigen::Index>(rows.size());
    const auto folds = static_cast<Eigen::Index>(kFolds);
    const Eigen::MatrixXd kernel = kernel_of(rows, shift);
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
      fit.diagonal().array() += kKernelRidge;
      const Eigen::MatrixXd miss =
          y(held, Eigen::all) - kernel(held, fitted) * fit.ldlt().solve(y(fitted, Eigen::all));
      const Eigen::ArrayXd error = miss.colwise().squaredNorm() / static_cast<double>(held.size());
      sum += log_share(error, variance).mean();
    }
    return sum / static_cast<double>(kFolds);
  }

  // Squared exponential of the standardised inputs, and products of the terms.
  Eigen::MatrixXd kernel_of(std::span<const std::size_t> rows, int shift) const {
    const auto count = static_cast<Eigen::Index>(rows.size());
    Eigen::MatrixXd x(static_cast<Eigen::Index>(rows_.inputs.size()), count);
    Eigen::MatrixXd phi(static_cast<Eigen::Index>(terms_), count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const std::size_t row = rows[static_cast<std::size_t>(i)];
      const std::size_t from = rows_.shifted(row, shift);
      fill(row, from, phi.col(i));
      Eigen::Index k = 0;
      for (const std::size_t state : states_) {
        x(k++, i) = rows_.inputs[state][row];
      }
      for (const std::size_t command : commands_) {
        x(k++, i) = rows_.inputs[command][from];
      }
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
    return (-kKernelGamma * distance.array()).exp().matrix() + kKernelTerms * phi.transpose() * phi;
  }

  Normal empty() const {
    const auto p = static_cast<Eigen::Index>(terms_);
    const auto m = static_cast<Eigen::Index>(rows_.targets.size());
    return {Eigen::MatrixXd::Zero(p, p), Eigen::MatrixXd::Zero(p, m), Eigen::VectorXd::Zero(m)};
  }

  Normal normal_of(std::size_t fold, int shift) const {
    constexpr Eigen::Index kAtOnce = 256;
    Normal sums = empty();
    Eigen::MatrixXd phi(static_cast<Eigen::Index>(terms_), kAtOnce);
    Eigen::MatrixXd y(static_cast<Eigen::Index>(rows_.targets.size()), kAtOnce);
    Eigen::Index filled = 0;
    const auto add = [&] {
      const auto some = phi.leftCols(filled);
      sums.design.noalias() += some * some.transpose();
      sums.answer.noalias() += some * y.leftCols(filled).transpose();
      sums.squares += y.leftCols(filled).rowwise().squaredNorm();
      sums.rows += static_cast<double>(filled);
      filled = 0;
    };
    const std::size_t end = rows_.size() * (fold + 1) / kFolds;
    for (std::size_t row = rows_.size() * fold / kFolds; row < end; row += every_) {
      fill(row, rows_.shifted(row, shift), phi.col(filled));
      for (std::size_t i = 0; i < rows_.targets.size(); ++i) {
        y(static_cast<Eigen::Index>(i), filled) = rows_.targets[i][row];
      }
      if (++filled == kAtOnce) {
        add();
      }
    }
    add();
    return sums;
  }

  void fill(std::size_t row, std::size_t from, Eigen::Ref<Eigen::VectorXd> phi) const {
    Eigen::Index k = 0;
    const auto add = [&](double x) {
      phi[k++] = x;
      phi[k++] = x * std::abs(x);
    };
    for (std::size_t i = 0; i < states_.size(); ++i) {
      const double v = rows_.inputs[states_[i]][row];
      add(v);
      for (std::size_t j = 0; j < i; ++j) {
        phi[k++] = v * rows_.inputs[states_[j]][row];
      }
    }
    for (const std::size_t command : commands_) {
      add(rows_.inputs[command][from]);
    }
    phi[k] = 1.0;
  }

  const AlignmentRows& rows_;
  std::size_t every_;  // rows are thinned where there are very many
  std::vector<std::size_t> states_;
  std::vector<std::size_t> commands_;
  std::size_t terms_ = 0;
};

std::string percent(double share) {
  return number_text(std::round(1000.0 * share) / 10.0) + " %";
}

// Fills in the shift that explains most, or why there is none.
void search_shift(const ShiftedFit& fit, double rate_hz, AlignmentFound& found) {
  const int farthest = static_cast<int>(kFarthestS * rate_hz);
  const int step = std::max(1, (farthest + kStepsPerSide - 1) / kStepsPerSide);
  const Eigen::ArrayXXd unshifted = fit.log_errors(0);
  int best = 0;
  double most = 0.0;
  double share = 0.0;
  for (int shift = step; shift <= farthest; shift += step) {
    for (const int sign : {1, -1}) {
      const Eigen::ArrayXXd gains = unshifted - fit.log_errors(sign * shift);
      if (gains.mean() > most) {
        best = sign * shift;
        most = gains.mean();
        share = (gains > 0.0).cast<double>().mean();
      }
    }
  }
  found.gain = 1.0 - std::exp(-most);
  const std::string evidence = percent(found.gain) + " of what is unexplained without, on " +
                               std::to_string(kFolds) + " folds of the training rows";
  const bool clear = most >= kLeastGain && share >= kGainingShare;
  // Where least squares describe the vehicle badly they may like commands that merely go with it.
  if (clear && fit.log_kernel_error(best) < fit.log_kernel_error(0)) {
    found.alignment.rows = best;
    found.alignment.shift_s = best / rate_hz;
    found.why = "this explains " + evidence;
  } else if (best == 0) {
    found.why = "no shift explains more";
  } else {
    found.why = "no shift is clearly better; the best explains " + evidence;
    found.gain = 0.0;
  }
}

}  // namespace

std::vector<std::size_t> find_commands(const AlignmentProblem& problem) {
  return commands_of(problem, AlignmentRows(problem));
}

AlignmentFound find_alignment(const AlignmentProblem& problem) {
  AlignmentFound found;
  const AlignmentRows rows(problem);
  const std::vector<std::size_t> commands = commands_of(problem, rows);
  for (const std::size_t command : commands) {
    found.alignment.commands.push_back(problem.input_names[command]);
  }
  if (commands.empty()) {
    found.why = "no inputs are known to be velocities and others commands";
    return found;
  }
  const ShiftedFit fit(rows, commands);
  const std::size_t needed = kRowsPerCoefficient * fit.terms();
  if (rows.size() < needed) {
    found.why = std::to_string(rows.size()) + " training rows are too few to tell a shift; " +
                std::to_string(needed) + " are needed";
  } else if (problem.rate_hz * kFarthestS < 1.0) {
    found.why = "rows are too far apart in time to tell a shift";
  } else {
    search_shift(fit, problem.rate_hz, found);
  }
  return found;
}

}  // namespace kelpie
