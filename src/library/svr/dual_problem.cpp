// SPDX-License-Identifier: Apache-2.0
#include "svr/dual_problem.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/vector.hpp"

namespace kelpie {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Eigen::Map<const Eigen::ArrayXd> as_array(std::span<const double> values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

std::size_t index_of(std::span<const double> gradient, const std::vector<double>& offset,
                     double value) {
  std::size_t i = 0;
  while (i + 1 < gradient.size() && gradient[i] + offset[i] != value) {
    ++i;  // NaN equals nothing
  }
  return i;
}

}  // namespace

DualProblem::DualProblem(std::size_t capacity, double epsilon, double c, Storage storage)
    : loss_{epsilon, c},
      kernel_(capacity, storage),
      target_(capacity),
      beta_(capacity),
      gradient_(capacity),
      lower_offset_(capacity),
      upper_offset_(capacity) {}

std::size_t DualProblem::bytes(std::size_t capacity, Storage storage) {
  constexpr std::size_t kVectors = 5;
  return KernelMatrix::bytes(capacity, storage) + kVectors * capacity * sizeof(double);
}

void DualProblem::add(std::span<const double> row, double self, double target) {
  const std::size_t i = size();
  target_[i] = target;
  gradient_[i] = target - dot(row.first(i), beta());
  kernel_.add(row, self);
  set_beta(i, 0.0);
}

void DualProblem::remove(std::size_t i) {
  hand_over(i);
  kernel_.remove(i);
  for (std::vector<double>* values :
       {&target_, &beta_, &gradient_, &lower_offset_, &upper_offset_}) {
    (*values)[i] = (*values)[size()];
  }
}

void DualProblem::clear() {
  kernel_.clear();
  shifts_ = 0;
}

void DualProblem::hand_over(std::size_t i) {
  while (beta_[i] != 0.0) {
    const bool positive = beta_[i] > 0.0;
    const double bound = positive ? loss_.c : -loss_.c;
    // Somebody has room: the other weights sum to −β_i, and so can't all be at the same bound.
    std::size_t heir = size();
    for (std::size_t j = 0; j < size(); ++j) {
      if (j != i && beta_[j] != bound && (heir == size() || kernel_(i, j) > kernel_(i, heir))) {
        heir = j;
      }
    }
    if (heir == size()) {  // a last sample's weight is rounding
      set_beta(i, 0.0);
      break;
    }
    const double part = std::min(std::abs(beta_[i]), std::abs(bound - beta_[heir]));
    positive ? shift(heir, i, part) : shift(i, heir, part);
  }
}

Kkt DualProblem::kkt() const {
  if (size() == 0) {
    return {};
  }
  const auto g = as_array(gradient());
  const auto n = static_cast<Eigen::Index>(size());
  Kkt kkt;
  kkt.lower = (g + Eigen::Map<const Eigen::ArrayXd>(lower_offset_.data(), n)).maxCoeff();
  kkt.upper = (g + Eigen::Map<const Eigen::ArrayXd>(upper_offset_.data(), n)).minCoeff();
  kkt.most_upward = index_of(gradient(), lower_offset_, kkt.lower);
  return kkt;
}

Kkt kkt_afresh(DualProblem problem) {
  for (std::size_t i = 0; i < problem.size(); ++i) {
    renew(problem, i);
  }
  return problem.kkt();
}

double objective(const DualProblem& problem) {
  // ½ βᵀKβ − yᵀβ = −½ βᵀ(y + g)
  const auto beta = as_array(problem.beta());
  return -0.5 * (beta * (as_array(problem.targets()) + as_array(problem.gradient()))).sum() +
         problem.loss().epsilon * beta.abs().sum();
}

double DualProblem::descend(std::size_t i, std::size_t j) {
  const double curved = curvature(kernel_, i, j);
  double slope = lower_bound(i) - upper_bound(j);
  double moved = 0.0;
  // Every round moves to the minimum, or to where ε‖β‖₁ has a kink, or to a bound: three at most.
  while (slope > 0.0) {
    const double end_i = beta_[i] < 0.0 ? 0.0 : loss_.c;
    const double end_j = beta_[j] > 0.0 ? 0.0 : -loss_.c;
    const double room_i = end_i - beta_[i];
    const double room_j = beta_[j] - end_j;
    const double step = std::min({slope / curved, room_i, room_j});
    moved += step;
    shift(i, j, step);
    if (step < std::min(room_i, room_j)) {
      break;
    }
    // Landing exactly on the kink or bound is what tells the lines of the KKT table apart.
    if (step == room_i) {
      set_beta(i, end_i);
    }
    if (step == room_j) {
      set_beta(j, end_j);
    }
    slope = lower_bound(i) - upper_bound(j);
  }
  return moved;
}

void DualProblem::shift(std::size_t i, std::size_t j, double delta) {
  set_beta(i, beta_[i] + delta);
  set_beta(j, beta_[j] - delta);
  kernel_.combine(std::array{i, j}, std::array{-delta, delta}, std::span(gradient_).first(size()));
  // Rounding errors add up; renewing once in 100 n shifts costs one part in a hundred.
  if (++shifts_ >= 100 * size()) {
    refresh();
  }
}

double renew(DualProblem& problem, std::size_t i) {
  const double before = problem.gradient()[i];
  problem.set_gradient(i, problem.targets()[i] - problem.kernel().dot(i, problem.beta()));
  return std::abs(problem.gradient()[i] - before);
}

void DualProblem::set_beta(std::size_t i, double beta) {
  beta_[i] = std::clamp(beta, -loss_.c, loss_.c);
  lower_offset_[i] =
      beta_[i] >= loss_.c ? -kInfinity : (beta_[i] < 0.0 ? loss_.epsilon : -loss_.epsilon);
  upper_offset_[i] =
      beta_[i] <= -loss_.c ? kInfinity : (beta_[i] > 0.0 ? -loss_.epsilon : loss_.epsilon);
}

void DualProblem::visit(Archive& archive) {
  archive.number(loss_.epsilon);
  archive.number(loss_.c);
  archive.require(loss_.epsilon >= 0.0 && loss_.c > 0.0, "has no tube");
  archive.part("kernel", kernel_);
  for (std::vector<double>* values : {&target_, &beta_, &gradient_}) {
    archive.numbers(std::span(*values).first(size()));
  }
  archive.whole(shifts_);
  for (std::size_t i = 0; archive.loading() && i < size(); ++i) {
    set_beta(i, beta_[i]);  // makes the offsets
  }
}

void DualProblem::refresh() {
  for (std::size_t i = 0; i < size(); ++i) {
    renew(*this, i);
  }
  shifts_ = 0;
}

}  // namespace kelpie
