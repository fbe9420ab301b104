// SPDX-License-Identifier: Apache-2.0
#include "log/command_clock.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "kelpie/motion/attitude.hpp"
#include "log/regression_columns.hpp"
#include "log/tuning.hpp"
#include "motion/states.hpp"

namespace kelpie::log {
namespace {

constexpr const auto& kCommands = kTuning.command_clock;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
using Matrix = Eigen::MatrixXd;
using Halves = std::array<double, 2>;

std::vector<double> column_of(const Dataset& data, bool is_input, std::size_t place) {
  std::vector<double> column;
  for (std::size_t row = 0; row < data.rows(); ++row) {
    column.push_back((is_input ? data.input(row) : data.target(row))[place]);
  }
  return column;
}

// The inputs that are neither velocities nor angles; empty where no velocity is known.
std::vector<std::size_t> commands_of(const Dataset& data, const std::string& states) {
  std::vector<std::size_t> velocities =
      find_states(states, data.input_names, data.target_names.size());
  for (std::size_t input = 0; input < named_velocities(data.input_names); ++input) {
    velocities.push_back(input);
  }
  const Attitude attitude = find_attitude(data.input_names);
  std::vector<std::size_t> commands;
  for (std::size_t input = 0; input < data.input_names.size() && !velocities.empty(); ++input) {
    if (std::ranges::count(velocities, input) == 0 && !attitude.contains(input)) {
      commands.push_back(input);
    }
  }
  return commands;
}

// Means of some columns over blocks of time; NaN where a block has few rows.
class Blocks {
 public:
  Blocks(const Dataset& data, double step_s) : rows_per_block_(data.rate_hz * step_s) {
    for (const double t : data.times_s) {
      const double block = std::floor((t - data.times_s.front()) / step_s);
      if (block < static_cast<double>(kCommands.most_blocks)) {
        block_.push_back(static_cast<std::size_t>(block));
      }
    }
    counts_.resize(block_.back() + 1);
    std::ranges::for_each(block_, [&](std::size_t block) { counts_[block] += 1.0; });
  }

  ColumnList means(ColumnList columns) const {
    for (std::vector<double>& column : columns) {
      std::vector<double> sums(counts_.size());
      for (std::size_t row = 0; row < block_.size(); ++row) {
        sums[block_[row]] += column[row];
      }
      for (std::size_t block = 0; block < sums.size(); ++block) {
        const bool is_whole = counts_[block] >= kCommands.least_filled * rows_per_block_;
        sums[block] =
            is_whole ? sums[block] / counts_[block] : std::numeric_limits<double>::quiet_NaN();
      }
      column = std::move(sums);
    }
    return columns;
  }

 private:
  double rows_per_block_;
  std::vector<std::size_t> block_;  // of each row
  std::vector<double> counts_;      // rows of each block
};

// First-order lag of a command's means.
std::vector<double> lagged(const std::vector<double>& values, double lag_in_blocks) {
  const double gain = 1.0 - std::exp(-1.0 / lag_in_blocks);
  std::vector<double> result;
  double state = values.front();
  for (const double value : values) {
    state += std::isfinite(state) ? gain * (std::isfinite(value) ? value - state : 0.0) : 0.0;
    state = std::isfinite(state) ? state : value;
    result.push_back(state);
  }
  return result;
}

// Fits of accelerations to velocities and shifted commands, in blocks of time.
class ShiftedFits {
 public:
  // `most`: the farthest shift, in blocks.
  ShiftedFits(const Dataset& data, const std::vector<std::size_t>& commands, double step_s,
              std::ptrdiff_t most) {
    ColumnList velocities;
    ColumnList angles;
    const Attitude attitude = find_attitude(data.input_names);
    for (std::size_t input = 0; input < data.input_names.size(); ++input) {
      std::vector<double> column = column_of(data, true, input);
      if (std::ranges::count(commands, input) > 0) {
        thrusts_.push_back(column);
        std::ranges::for_each(column, [](double& n) { n *= std::abs(n); });
        thrusts_.push_back(std::move(column));
      } else {
        (attitude.contains(input) ? angles : velocities).push_back(std::move(column));
      }
    }
    ColumnList targets;
    for (std::size_t target = 0; target < data.target_names.size(); ++target) {
      targets.push_back(column_of(data, false, target));
    }
    ColumnList background = drag_terms(velocities);
    std::ranges::move(angles, std::back_inserter(background));
    const Blocks blocks(data, step_s);
    thrusts_ = blocks.means(std::move(thrusts_));
    background = blocks.means(std::move(background));
    targets = blocks.means(std::move(targets));
    choose_rows(background, targets, most);
    for (std::size_t half = 0; half < rows_.size() && is_possible(); ++half) {
      background_[half] = standardised(background, rows_[half]);
      Matrix normal = background_[half].transpose() * background_[half];
      normal.diagonal().array() += kCommands.ridge * static_cast<double>(rows_[half].size());
      solver_[half].compute(normal);
      const Matrix wanted = standardised(targets, rows_[half]);
      targets_[half] = without_background(half, wanted);
      size_[half] = wanted.colwise().squaredNorm().transpose();
    }
  }

  bool is_possible() const {
    return rows_[0].size() >= kCommands.rows_per_coefficient * coefficients_;
  }

  // Logarithms of the unexplained shares, summed over the targets, of each half of the log, with
  // Akaike's penalty.
  Halves left_at(std::ptrdiff_t shift) const { return left(thrusts_, shift); }

  // The same where thrusters, or motions that no input measures, answer slowly.
  Halves left_with_history(double step_s) const {
    ColumnList history = thrusts_;
    for (const double lag_s : kCommands.lags_s) {
      std::ranges::transform(thrusts_, std::back_inserter(history),
                             [&](const auto& thrust) { return lagged(thrust, lag_s / step_s); });
    }
    return left(history, 0);
  }

 private:
  // The same blocks for every shift, so that shifts can be compared.
  void choose_rows(const ColumnList& background, const ColumnList& targets, std::ptrdiff_t most) {
    const auto is_whole = [](const ColumnList& columns, std::size_t block) {
      return std::ranges::all_of(columns,
                                 [&](const auto& column) { return std::isfinite(column[block]); });
    };
    coefficients_ = 1 + background.size() + thrusts_.size();
    std::vector<std::size_t> rows;
    const auto blocks = std::ssize(targets.front());
    std::ptrdiff_t whole = 0;  // blocks with commands, on end, up to `most` after this one
    for (std::ptrdiff_t last = 0; last < blocks; ++last) {
      whole = is_whole(thrusts_, static_cast<std::size_t>(last)) ? whole + 1 : 0;
      const auto block = static_cast<std::size_t>(std::max<std::ptrdiff_t>(last - most, 0));
      if (whole > 2 * most && is_whole(background, block) && is_whole(targets, block)) {
        rows.push_back(block);
      }
    }
    const auto middle = rows.begin() + std::ssize(rows) / 2;
    rows_ = {std::vector(rows.begin(), middle), std::vector(middle, rows.end())};
  }

  Matrix without_background(std::size_t half, const Matrix& columns) const {
    return columns -
           background_[half] * solver_[half].solve(background_[half].transpose() * columns);
  }

  Halves left(const ColumnList& thrusts, std::ptrdiff_t shift) const {
    Halves logarithms{};
    for (std::size_t half = 0; half < rows_.size(); ++half) {
      std::vector<std::size_t> rows = rows_[half];
      std::ranges::for_each(rows,
                            [&](std::size_t& row) { row += static_cast<std::size_t>(shift); });
      const Matrix pushed = without_background(half, standardised(thrusts, rows));
      Matrix normal = pushed.transpose() * pushed;
      normal.diagonal().array() += kCommands.ridge * static_cast<double>(rows.size());
      const Matrix weights = normal.ldlt().solve(pushed.transpose() * targets_[half]);
      const Eigen::ArrayXd rest =
          (targets_[half] - pushed * weights).colwise().squaredNorm().transpose().array();
      const Eigen::ArrayXd share = rest / size_[half].array().max(kCommands.least_left);
      logarithms.at(half) =
          (share.max(kCommands.least_left).log() +
           2.0 * static_cast<double>(pushed.cols()) / static_cast<double>(rows.size()))
              .sum();
    }
    return logarithms;
  }

  ColumnList thrusts_;
  std::size_t coefficients_ = 0;
  std::array<std::vector<std::size_t>, 2> rows_;  // blocks of each half of the log
  std::array<Matrix, 2> background_;
  std::array<Eigen::LDLT<Matrix>, 2> solver_;
  std::array<Matrix, 2> targets_;  // without what the background explains
  std::array<Eigen::VectorXd, 2> size_;
};

// A shift beyond those of thrusters, and how much less it leaves unexplained, in logarithms.
struct FoundShift {
  std::ptrdiff_t blocks = 0;
  double gain = 0.0;  // in the half of the log with the smaller gain
};

FoundShift search(const ShiftedFits& fits, std::ptrdiff_t most, double step_s, double align_s) {
  Halves near{kInfinity, kInfinity};
  Halves far{kInfinity, kInfinity};
  std::array<std::ptrdiff_t, 2> places{};
  std::vector<Halves> all;
  const auto keep_least = [](Halves& least, const Halves& tried) {
    least = {std::min(least[0], tried[0]), std::min(least[1], tried[1])};
  };
  for (std::ptrdiff_t shift = -most; shift <= most; ++shift) {
    const Halves left = all.emplace_back(fits.left_at(shift));
    if (std::abs(static_cast<double>(shift) * step_s - align_s) <= kCommands.near_s) {
      keep_least(near, left);
      all.back() = {kInfinity, kInfinity};
      continue;
    }
    for (std::size_t half = 0; half < left.size(); ++half) {
      places.at(half) = left.at(half) < far.at(half) ? shift : places.at(half);
    }
    keep_least(far, left);
  }
  keep_least(near, fits.left_with_history(step_s));
  const auto best =
      std::ranges::min_element(all, {}, [](const Halves& left) { return left[0] + left[1]; });
  const std::ptrdiff_t place = best - all.begin() - most;
  const bool agree = std::ranges::all_of(places, [&](std::ptrdiff_t own) {
    return static_cast<double>(std::abs(own - place)) * step_s <= kCommands.agreement_s;
  });
  return {place, agree ? std::min(near[0] - (*best)[0], near[1] - (*best)[1]) : 0.0};
}

// The shift in seconds, to a fraction of the blocks of the search.
double refined(const Dataset& data, const std::vector<std::size_t>& commands, double shift_s,
               double step_s) {
  const double fine_s = std::max(step_s / kCommands.finer, 1.0 / data.rate_hz);
  const auto around = static_cast<std::ptrdiff_t>(std::ceil(step_s / fine_s));
  const auto middle = static_cast<std::ptrdiff_t>(std::round(shift_s / fine_s));
  const ShiftedFits fits(data, commands, fine_s, std::abs(middle) + around);
  if (!fits.is_possible()) {
    return shift_s;
  }
  double least = kInfinity;
  for (std::ptrdiff_t shift = middle - around; shift <= middle + around; ++shift) {
    const Halves left = fits.left_at(shift);
    if (left[0] + left[1] < least) {
      least = left[0] + left[1];
      shift_s = static_cast<double>(shift) * fine_s;
    }
  }
  return shift_s;
}

}  // namespace

std::optional<Mistake> command_clock_mistake(const Dataset& data, const std::string& states,
                                             double align_s) {
  const double duration_s = data.rows() < 2 ? 0.0 : data.times_s.back() - data.times_s.front();
  const double step_s = std::max(kCommands.step_s, 1.0 / data.rate_hz);
  const auto most = static_cast<std::ptrdiff_t>(
      std::min(kCommands.farthest_s, kCommands.longest_part * duration_s) / step_s);
  const std::vector<std::size_t> commands = commands_of(data, states);
  if (commands.empty() || duration_s < kCommands.least_s || most < 1) {
    return std::nullopt;
  }
  const ShiftedFits fits(data, commands, step_s, most);
  const FoundShift found = fits.is_possible() ? search(fits, most, step_s, align_s) : FoundShift{};
  if (found.gain < kCommands.least_gain) {
    return std::nullopt;
  }
  const double shift_s =
      refined(data, commands, static_cast<double>(found.blocks) * step_s, step_s);
  const std::string how = fmt::format(
      "the commands come {:.3g} s {}: accelerations that the velocities do not explain "
      "go with the commands logged {} ({:.0f} % less is left unexplained)",
      std::abs(shift_s), shift_s > 0.0 ? "late" : "early", shift_s > 0.0 ? "later" : "earlier",
      100.0 * (1.0 - std::exp(-found.gain)));
  const std::string remedy =
      std::abs(shift_s) <= kCommands.most_aligned_s
          ? fmt::format("--align {:.3g} takes them so", shift_s)
          : fmt::format(
                "shift the columns of the commands, or their messages by lag = {:.3g} in "
                "[log]",
                shift_s);
  return Mistake{how + ": the two have different clocks", remedy,
                 found.gain >= kCommands.certain_gain};
}

}  // namespace kelpie::log
