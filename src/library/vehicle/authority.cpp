// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "core/bounded_minimum.hpp"
#include "core/decomposition.hpp"
#include "core/eigen.hpp"
#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/vehicle/diagnosis.hpp"
#include "motion/states.hpp"
#include "vehicle/tuning.hpp"
#include "vehicle/wording.hpp"

namespace kelpie {
namespace {

Eigen::Map<const Eigen::VectorXd> column(const std::vector<double>& values) {
  return as_vector(values);
}

void check_range(const Diagnosis& diagnosis, const CommandRange& range) {
  const auto is_input = [&](const Cause& thruster) { return thruster.place == range.input; };
  require(std::ranges::any_of(diagnosis.present(), is_input), "ranges",
          "input " + std::to_string(range.input) + " is no thruster");
  require(std::isfinite(range.least) && std::isfinite(range.most), "ranges", "have to be finite");
  require(range.least <= 0.0 && range.most >= 0.0 && range.least < range.most, "ranges",
          "have to contain 0, the command at rest, and more");
}

// A thruster's effect, with the share of full thrust at half the command on either side.
ThrusterEffect effect_of(const Diagnosis& diagnosis, const CommandRange& range,
                         std::array<double, 2>& half) {
  const std::size_t axes = diagnosis.states().size();
  ThrusterEffect effect{.range = range,
                        .ahead = std::vector<double>(axes),
                        .astern = std::vector<double>(axes),
                        .ahead_width = std::vector<double>(axes),
                        .astern_width = std::vector<double>(axes),
                        .nominal_ahead = std::vector<double>(axes),
                        .nominal_astern = std::vector<double>(axes)};
  diagnosis.thrust(range.input, range.most, false, effect.ahead, effect.ahead_width);
  diagnosis.thrust(range.input, range.least, false, effect.astern, effect.astern_width);
  diagnosis.thrust(range.input, range.most, true, effect.nominal_ahead);
  diagnosis.thrust(range.input, range.least, true, effect.nominal_astern);
  std::vector<double> middle(axes);
  const auto share_at = [&](double command, const std::vector<double>& full) {
    diagnosis.thrust(range.input, command, true, middle);
    const double square = column(full).squaredNorm();
    return square > 0.0 ? column(full).dot(column(middle)) / square : 0.5;
  };
  half = {share_at(0.5 * range.most, effect.nominal_ahead),
          share_at(0.5 * range.least, effect.nominal_astern)};
  return effect;
}

}  // namespace

double AxisAuthority::left() const {
  const double nominal = nominal_most - nominal_least;
  return nominal > 0.0 ? (most - least) / nominal : 1.0;
}

Authority::Authority(const Diagnosis& diagnosis, const std::vector<CommandRange>& ranges)
    : body_axes_(diagnosis.body_axes().begin(), diagnosis.body_axes().end()) {
  require(!ranges.empty(), "ranges", "have to name a thruster or more");
  require(diagnosis.knows_thrust(), "diagnosis",
          "knows too little of the vehicle so far: it takes some minutes of driving");
  for (const CommandRange& range : ranges) {
    check_range(diagnosis, range);
    require(std::ranges::count(ranges, range.input, &CommandRange::input) == 1, "ranges",
            "name input " + std::to_string(range.input) + " twice");
    thrusters_.push_back(effect_of(diagnosis, range, half_.emplace_back()));
  }
  axes_.resize(diagnosis.states().size());
  scale_.resize(axes_.size());
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    axes_[i] = {.most = attainable(i, 1.0, false),
                .least = attainable(i, -1.0, false),
                .nominal_most = attainable(i, 1.0, true),
                .nominal_least = attainable(i, -1.0, true)};
    scale_[i] = std::max(
        {axes_[i].nominal_most, -axes_[i].nominal_least, std::numeric_limits<double>::min()});
  }
  for (ThrusterEffect& one : thrusters_) {
    Eigen::VectorXd now(2 * column(scale_).size());
    Eigen::VectorXd nominal(now.size());
    const auto scaled = [&](const std::vector<double>& values) {
      return Eigen::VectorXd(column(values).cwiseQuotient(column(scale_)));
    };
    now << scaled(one.ahead), scaled(one.astern);
    nominal << scaled(one.nominal_ahead), scaled(one.nominal_astern);
    const double square = nominal.squaredNorm();
    one.share = square > 0.0 ? std::max(0.0, now.dot(nominal) / square) : 1.0;
  }
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    axes_[i].alone_most = attainable_alone(i, 1.0);
    axes_[i].alone_least = -attainable_alone(i, -1.0);
  }
  find_singular_values();
  find_held_current(diagnosis);
}

// Σ of what each thruster can give along ±axis: ahead, astern or nothing.
double Authority::attainable(std::size_t axis, double sign, bool nominal) const {
  double sum = 0.0;
  for (const ThrusterEffect& one : thrusters_) {
    const double ahead = sign * (nominal ? one.nominal_ahead : one.ahead)[axis];
    const double astern = sign * (nominal ? one.nominal_astern : one.astern)[axis];
    sum += std::max({ahead, astern, 0.0});
  }
  return sign * sum;
}

// The greatest acceleration along ±axis that leaves the other axes at 0, by bisection.
double Authority::attainable_alone(std::size_t axis, double sign) const {
  double low = 0.0;
  double high = std::abs(sign > 0.0 ? axes_[axis].most : axes_[axis].least);
  std::vector<double> wanted(axes_.size());
  for (int round = 0; round < kAuthority.bisections; ++round) {
    const double middle = 0.5 * (low + high);
    wanted[axis] = sign * middle;
    (allocate(wanted).missing <= kAuthority.reached ? low : high) = middle;
  }
  return low;
}

void Authority::find_singular_values() {
  const auto rows = static_cast<Eigen::Index>(axes_.size());
  Eigen::MatrixXd now(rows, 2 * std::ssize(thrusters_));
  Eigen::MatrixXd nominal(now.rows(), now.cols());
  for (std::size_t k = 0; k < thrusters_.size(); ++k) {
    const auto place = static_cast<Eigen::Index>(2 * k);
    now.col(place) = column(thrusters_[k].ahead).cwiseQuotient(column(scale_));
    now.col(place + 1) = column(thrusters_[k].astern).cwiseQuotient(column(scale_));
    nominal.col(place) = column(thrusters_[k].nominal_ahead).cwiseQuotient(column(scale_));
    nominal.col(place + 1) = column(thrusters_[k].nominal_astern).cwiseQuotient(column(scale_));
  }
  const SingularPairs of_now = singular_pairs(now);
  const Eigen::VectorXd of_nominal = singular_pairs(nominal).values;
  singular_.assign(axes_.size(), 0.0);
  nominal_singular_.assign(axes_.size(), 0.0);
  for (Eigen::Index i = 0; i < of_nominal.size(); ++i) {
    singular_[static_cast<std::size_t>(i)] = of_now.values(i);
    nominal_singular_[static_cast<std::size_t>(i)] = of_nominal(i);
  }
  lost_ = axes_.size();
  if (!axes_.empty() && singular_.back() < kAuthority.near_singular * nominal_singular_.back()) {
    Eigen::Index axis = 0;
    of_now.left.col(of_now.left.cols() - 1).cwiseAbs().maxCoeff(&axis);
    lost_ = static_cast<std::size_t>(axis);
  }
}

void Authority::find_held_current(const Diagnosis& diagnosis) {
  const auto surge = std::ranges::find(body_axes_, std::size_t{0});
  if (surge == body_axes_.end()) {
    held_current_ = std::numeric_limits<double>::quiet_NaN();
    return;
  }
  const auto axis = static_cast<std::size_t>(surge - body_axes_.begin());
  std::vector<double> x(diagnosis.inputs());
  std::vector<double> drag(axes_.size());
  double low = 0.0;
  double high = kAuthority.fastest_current;
  for (int round = 0; round < kAuthority.bisections; ++round) {
    const double middle = 0.5 * (low + high);
    x[diagnosis.states()[axis]] = middle;
    diagnosis.accelerations(x, drag);
    std::vector<double> wanted(axes_.size());
    wanted[axis] = -drag[axis];
    (allocate(wanted).missing <= kAuthority.reached ? low : high) = middle;
  }
  held_current_ = low;
}

// Shares of full ahead and full astern, in turn; of each thruster one is 0.
std::vector<double> Authority::shares_for(std::span<const double> wanted) const {
  const auto columns = 2 * std::ssize(thrusters_);
  Eigen::MatrixXd b(std::ssize(axes_), columns);
  for (std::size_t k = 0; k < thrusters_.size(); ++k) {
    const auto place = static_cast<Eigen::Index>(2 * k);
    b.col(place) = column(thrusters_[k].ahead).cwiseQuotient(column(scale_));
    b.col(place + 1) = column(thrusters_[k].astern).cwiseQuotient(column(scale_));
  }
  const Eigen::VectorXd tau = as_vector(wanted).cwiseQuotient(column(scale_));
  Eigen::MatrixXd h = b.transpose() * b;
  h.diagonal().array() += kAuthority.ridge;
  const Eigen::VectorXd lower = Eigen::VectorXd::Zero(columns);
  Eigen::VectorXd upper = Eigen::VectorXd::Ones(columns);
  for (std::size_t k = 0; k < thrusters_.size(); ++k) {
    const auto place = static_cast<Eigen::Index>(2 * k);
    const bool is_dead = thrusters_[k].share < kAuthority.dead;
    upper(place) = is_dead || thrusters_[k].range.most == 0.0 ? 0.0 : 1.0;
    upper(place + 1) = is_dead || thrusters_[k].range.least == 0.0 ? 0.0 : 1.0;
  }
  const Eigen::VectorXd g = b.transpose() * tau;
  Eigen::VectorXd z(columns);
  const auto solve = [&] {
    bounded_minimum({h.data(), static_cast<std::size_t>(h.size())},
                    {g.data(), static_cast<std::size_t>(g.size())},
                    {lower.data(), static_cast<std::size_t>(lower.size())},
                    {upper.data(), static_cast<std::size_t>(upper.size())},
                    {z.data(), static_cast<std::size_t>(z.size())});
  };
  solve();
  for (bool is_open = true; is_open;) {
    is_open = false;
    for (Eigen::Index k = 0; k < columns; k += 2) {
      if (z(k) > 0.0 && z(k + 1) > 0.0) {
        upper(z(k) > z(k + 1) ? k + 1 : k) = 0.0;
        is_open = true;
      }
    }
    if (is_open) {
      solve();
    }
  }
  return {z.begin(), z.end()};
}

// Thrust is αn + βn² on either side of 0; half the command gives the share `half` of full thrust.
double Authority::command_for(std::size_t thruster, double share) const {
  const bool is_ahead = share >= 0.0;
  const double full = is_ahead ? thrusters_[thruster].range.most : thrusters_[thruster].range.least;
  const double half = half_[thruster][is_ahead ? 0 : 1];
  double low = 0.0;
  double high = 1.0;
  const double linear = 4.0 * half - 1.0;  // share(s) = linear s + (1 − linear) s²
  for (int round = 0; round < kAuthority.bisections; ++round) {
    const double middle = 0.5 * (low + high);
    (linear * middle + (1.0 - linear) * middle * middle < std::abs(share) ? low : high) = middle;
  }
  return high * full;
}

Allocation Authority::allocate(std::span<const double> wanted) const {
  require_size("wanted", wanted.size(), axes_.size());
  require(std::ranges::all_of(wanted, [](double value) { return std::isfinite(value); }), "wanted",
          "has to be finite");
  const std::vector<double> shares = shares_for(wanted);
  Allocation allocation{.commands = {}, .reached = std::vector<double>(axes_.size())};
  for (std::size_t k = 0; k < thrusters_.size(); ++k) {
    const double ahead = shares[2 * k];
    const double astern = shares[2 * k + 1];
    allocation.commands.push_back(ahead + astern > 0.0 ? command_for(k, ahead - astern) : 0.0);
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      allocation.reached[i] += ahead * thrusters_[k].ahead[i] + astern * thrusters_[k].astern[i];
    }
  }
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const double off = std::abs(wanted[i] - allocation.reached[i]) / scale_[i];
    allocation.missing = std::max(allocation.missing, off);
  }
  return allocation;
}

std::string Authority::text(const DiagnosisNames& names, std::string_view speed_unit) const {
  const auto axis_name = [&](std::size_t i) {
    return body_axes_[i] < kAxisTexts.size() ? std::string(kAxisTexts.at(body_axes_[i]))
                                             : names.targets[i];
  };
  std::string text;
  if (lost_ < axes_.size()) {
    text = "NEARLY NO AUTHORITY left in " + axis_name(lost_) + "; ";
  }
  std::vector<std::string> parts;
  for (const ThrusterEffect& one : thrusters_) {
    if (std::abs(one.share - 1.0) >= kDiagnosis.least_share) {
      parts.push_back(names.inputs[one.range.input] + " gives " + text_of(100.0 * one.share, 0) +
                      " % of its thrust");
    }
  }
  text += parts.empty() ? "no thruster is known to have changed" : join_text(parts, ", ");
  parts.clear();
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    parts.push_back(axis_name(i) + " " + text_of(axes_[i].left(), 2));
  }
  text += ": " + join_text(parts, ", ") + " of nominal left";
  if (std::isfinite(held_current_)) {
    text += "; holds a current of " + text_of(held_current_, 2);
    text += speed_unit.empty() ? "" : " " + std::string(speed_unit);
    text += " from ahead";
  }
  return text;
}

}  // namespace kelpie
