// SPDX-License-Identifier: Apache-2.0
#include "model/six_axis_fit.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/eigen.hpp"
#include "core/quantile.hpp"
#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/model/alignment.hpp"
#include "model/six_axis_structure.hpp"
#include "motion/minimum_distance.hpp"
#include "motion/tuning.hpp"
#include "motion/weak_form.hpp"

namespace kelpie {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr std::array<const char*, SixAxisPlace::thrusters> kVehicleNames{
    "surge_inertia",        "sway_inertia",        "heave_inertia",        "roll_inertia",
    "pitch_inertia",        "yaw_inertia",         "low_centre",           "forward_centre",
    "surge_linear_drag",    "sway_linear_drag",    "heave_linear_drag",    "roll_linear_drag",
    "pitch_linear_drag",    "yaw_linear_drag",     "surge_quadratic_drag", "sway_quadratic_drag",
    "heave_quadratic_drag", "roll_quadratic_drag", "pitch_quadratic_drag", "yaw_quadratic_drag",
    "net_weight",           "roll_moment",         "pitch_moment",         "righting_moment"};
constexpr std::array<const char*, SixAxisPlace::curve_size> kCurveNames{"lag", "delay", "dead_band",
                                                                        "volts_exponent"};
constexpr std::array<double ThrustCurve::*, SixAxisPlace::curve_size> kCurve{
    &ThrustCurve::lag_s, &ThrustCurve::delay_s, &ThrustCurve::dead_band, &ThrustCurve::exponent};
// Differences for derivatives by, and the largest steps and values of, the parameters above.
constexpr std::array kNudge{0.005, 0.005, 0.005, 0.05};
constexpr std::array kMostStep{0.1, 0.1, 0.05, 0.5};
constexpr std::array kMostValue{5.0, 2.0, 0.5, 3.0};

std::vector<std::string> names_of(const std::vector<PlacedThruster>& thrusters) {
  std::vector<std::string> names(kVehicleNames.begin(), kVehicleNames.end());
  for (const PlacedThruster& thruster : thrusters) {
    names.push_back(thruster.name + ".forward");
    names.push_back(thruster.name + ".reverse");
  }
  for (const char* const name : kCurveNames) {
    names.push_back(std::string("thrusters.") + name);
  }
  return names;
}

// rows × thrusters.
Eigen::MatrixXd speeds_of(const SixAxisRows& rows, const ThrustCurve& curve) {
  const std::vector<double> speeds = thruster_speeds(rows, curve);
  return Eigen::Map<const RowMajor>(speeds.data(), place_of(rows.rows()),
                                    place_of(rows.thrusters.size()));
}

// Newtons of each thruster, rows × thrusters.
Eigen::MatrixXd thrusts_of(const Eigen::MatrixXd& speeds, const Eigen::VectorXd& parameters) {
  Eigen::MatrixXd thrusts = speeds.cwiseProduct(speeds.cwiseAbs());
  for (Eigen::Index i = 0; i < thrusts.cols(); ++i) {
    const Eigen::Index at = place_of(SixAxisPlace::thruster(static_cast<std::size_t>(i)));
    for (double& value : thrusts.col(i)) {
      value *= value > 0.0 ? parameters(at) : parameters(at + 1);
    }
  }
  return thrusts;
}

// One fit at one length of window.
class Search {
 public:
  Search(const SixAxisRows& rows, const SixAxisSettings& options, double half_s)
      : rows_(rows),
        structure_(rows.thrusters),
        arms_(thruster_arms(rows.thrusters)),
        shape_{.half_s = half_s, .stride_s = kIdentification.stride_share * half_s},
        curve_(options.start) {
    active_ = {options.find_times, options.find_times, true, has_volts(rows)};
    if (!active_[3]) {
      curve_.exponent = 0.0;
    }
  }

  // Whether there are enough windows; otherwise nothing is found.
  bool run() {
    if (!iterate(false)) {
      return false;
    }
    for (int step = 0; step < kIdentification.curve_steps; ++step) {
      if (!iterate(true)) {
        return false;
      }
      if (step == 1) {
        leave_out_what_is_not_told();
      }
      if (!move()) {
        break;
      }
    }
    errors_ = sandwich(free_, structure_.equation(), best_);
    return true;
  }

  // Σ ln of the standard errors of vehicle and thrusters.
  double log_errors() const {
    double sum = 0.0;
    const Eigen::Index curve = place_of(SixAxisPlace::curve(rows_.thrusters.size()));
    for (std::size_t i = 0; i < best_.free.size(); ++i) {
      if (best_.free[i] < curve) {
        const double variance = errors_.covariance(place_of(i), place_of(i));
        sum += 0.5 * std::log(std::max(variance, std::numeric_limits<double>::min()));
      }
    }
    return sum;
  }

  const ThrustCurve& curve() const { return curve_; }
  SixAxisFit collected() const;

 private:
  // The same windows and thrust curve over other rows.
  Search(const SixAxisRows& rows, const Search& like)
      : rows_(rows),
        structure_(rows.thrusters),
        arms_(like.arms_),
        shape_(like.shape_),
        curve_(like.curve_),
        active_(like.active_),
        best_(like.best_) {}

  static bool has_volts(const SixAxisRows& rows) {
    if (rows.volts.empty()) {
      return false;
    }
    const auto [least, most] = std::ranges::minmax_element(rows.volts);
    return *most > kIdentification.least_volts_ratio * *least;
  }

  Eigen::MatrixXd plain_terms(const Eigen::MatrixXd& speeds) const {
    const MotionTerms& terms = structure_.terms();
    const Eigen::Index count = place_of(rows_.rows());
    Eigen::MatrixXd values(count, place_of(terms.size()));
    std::vector<double> inputs(9 + rows_.thrusters.size());
    std::vector<double> row_terms(terms.size());
    for (Eigen::Index row = 0; row < count; ++row) {
      const auto at = static_cast<std::size_t>(row);
      std::copy_n(rows_.velocities.begin() + static_cast<std::ptrdiff_t>(6 * at), 6,
                  inputs.begin());
      std::copy_n(rows_.down.begin() + static_cast<std::ptrdiff_t>(3 * at), 3, inputs.begin() + 6);
      for (std::size_t i = 0; i < rows_.thrusters.size(); ++i) {
        inputs[9 + i] = speeds(row, place_of(i));
      }
      terms.evaluate(inputs, row_terms);
      values.row(row) = Eigen::Map<const Eigen::RowVectorXd>(row_terms.data(), values.cols());
    }
    return values;
  }

  // Derivatives of the forces on six axes by the parameters of the curve, rows × 24.
  Eigen::MatrixXd curve_terms() const {
    Eigen::MatrixXd values = Eigen::MatrixXd::Zero(place_of(rows_.rows()), 24);
    for (std::size_t k = 0; k < kCurve.size(); ++k) {
      if (!active_[k]) {
        continue;
      }
      ThrustCurve above = curve_;
      ThrustCurve below = curve_;
      above.*kCurve[k] += kNudge[k];
      below.*kCurve[k] = std::max(0.0, below.*kCurve[k] - kNudge[k]);
      const Eigen::MatrixXd change = thrusts_of(speeds_of(rows_, above), best_.parameters) -
                                     thrusts_of(speeds_of(rows_, below), best_.parameters);
      values.middleCols(place_of(6 * k), 6) =
          change * arms_.transpose() / (above.*kCurve[k] - below.*kCurve[k]);
    }
    return values;
  }

  bool iterate(bool with_curve) {
    const Eigen::MatrixXd plain = plain_terms(speeds_of(rows_, curve_));
    EquationRows equation{
        .times_s = rows_.times_s,
        .starts = rows_.starts,
        .velocities = Eigen::Map<const RowMajor>(rows_.velocities.data(), plain.rows(), 6),
        .terms = Eigen::MatrixXd(plain.rows(), plain.cols() + (with_curve ? 24 : 0))};
    equation.terms.leftCols(plain.cols()) = plain;
    if (with_curve) {
      equation.terms.rightCols(24) = curve_terms();
    }
    weak_ = weak_rows(equation, shape_);
    if (static_cast<double>(weak_.terms.rows()) <
        kIdentification.windows_per_term * static_cast<double>(weak_.terms.cols())) {
      return false;
    }
    free_ = fit_freely(weak_, kIdentification.pieces);
    if (best_.parameters.size() == 0) {
      guess();
    }
    best_.free = sought(with_curve);
    best_.parameters.tail(place_of(SixAxisPlace::curve_size)).setZero();
    best_ = minimise_distance(free_, structure_.equation(), std::move(best_));
    return true;
  }

  // Inertias at which accelerations of all axes weigh alike.
  void guess() {
    best_.parameters = Eigen::VectorXd::Zero(structure_.parameters());
    const double push = std::sqrt(free_.noise.diagonal().head(3).mean());
    for (Eigen::Index axis = 0; axis < 6; ++axis) {
      best_.parameters(axis) =
          axis < 3 ? 1.0 : push / std::max(std::sqrt(free_.noise(axis, axis)), 1e-300);
    }
  }

  std::vector<Eigen::Index> sought(bool with_curve) const {
    std::vector<Eigen::Index> places;
    for (Eigen::Index place = 1; place < place_of(SixAxisPlace::thrusters); ++place) {
      places.push_back(place);
    }
    const Eigen::Index first = place_of(structure_.terms().size() - 2 * rows_.thrusters.size());
    for (Eigen::Index i = 0; i < place_of(2 * rows_.thrusters.size()); ++i) {
      if (free_.gram(first + i, first + i) > 0.0) {
        places.push_back(place_of(SixAxisPlace::thrusters) + i);
      }
    }
    for (std::size_t k = 0; with_curve && k < kCurve.size(); ++k) {
      if (active_[k]) {
        places.push_back(place_of(SixAxisPlace::curve(rows_.thrusters.size()) + k));
      }
    }
    return places;
  }

  // Share of the forces on an axis that one standard error of each sought parameter makes up.
  Eigen::VectorXd blurs(const Eigen::MatrixXd& covariance) const {
    const Eigen::MatrixXd jacobian =
        structure_.residual(free_.coefficients, best_.parameters).jacobian;
    const Eigen::MatrixXd inertial =
        weak_.acceleration * structure_.mass(best_.parameters).transpose();
    const auto count = static_cast<double>(weak_.terms.rows());
    const Eigen::Index terms = weak_.terms.cols();
    Eigen::VectorXd blurs(place_of(best_.free.size()));
    for (Eigen::Index i = 0; i < blurs.size(); ++i) {
      const Eigen::VectorXd column = jacobian.col(best_.free[static_cast<std::size_t>(i)]);
      double most = 0.0;
      for (Eigen::Index axis = 0; axis < 6; ++axis) {
        const Eigen::VectorXd effect = column(Eigen::seqN(axis, terms, 6));
        const double size = std::sqrt(std::max(0.0, effect.dot(free_.gram * effect)) / count);
        const double all = inertial.col(axis).norm() / std::sqrt(count);
        most = std::max(most, size / std::max(all, std::numeric_limits<double>::min()));
      }
      blurs(i) = most * std::sqrt(std::max(0.0, covariance(i, i)));
    }
    return blurs;
  }

  void leave_out_what_is_not_told() {
    const Eigen::VectorXd blur = blurs(sandwich(free_, structure_.equation(), best_).covariance);
    const Eigen::Index first = place_of(SixAxisPlace::curve(rows_.thrusters.size()));
    for (std::size_t i = 0; i < best_.free.size(); ++i) {
      const Eigen::Index k = best_.free[i] - first;
      if (k >= 0 && blur(place_of(i)) > kIdentification.most_blur) {
        active_[static_cast<std::size_t>(k)] = false;
        best_.parameters(first + k) = 0.0;
      }
    }
  }

  // A step of the curve; whether it was of any size.
  bool move() {
    bool moved = false;
    const Eigen::Index first = place_of(SixAxisPlace::curve(rows_.thrusters.size()));
    for (std::size_t k = 0; k < kCurve.size(); ++k) {
      if (active_[k]) {
        const double step =
            std::clamp(best_.parameters(first + place_of(k)), -kMostStep[k], kMostStep[k]);
        double& value = curve_.*kCurve[k];
        value = std::clamp(value + step, 0.0, kMostValue[k]);
        moved = moved || std::abs(step) > kIdentification.least_curve_step * kMostStep[k];
      }
    }
    return moved;
  }

  // Covariance of the sought parameters by scale and bias of each axis of the velocity log, evenly
  // distributed within what data sheets promise: the fit is repeated with each error, to both
  // sides. A bias of heave or surge looks like a moment of the added mass, and so like a centre of
  // gravity off the origin, and a bias of heave like weight.
  Eigen::MatrixXd velocity_covariance() const {
    Eigen::MatrixXd effects(best_.parameters.size(), 6);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double scale = kIdentification.velocity_scale;
      const double bias = kIdentification.velocity_bias_m_s;
      effects.col(place_of(axis)) =
          0.5 * (with_error(axis, scale, 0.0) - with_error(axis, -scale, 0.0));
      effects.col(place_of(3 + axis)) =
          0.5 * (with_error(axis, 0.0, bias) - with_error(axis, 0.0, -bias));
    }
    const Eigen::MatrixXd sought = effects(best_.free, Eigen::all);
    return sought * sought.transpose() / 3.0;
  }

  Eigen::VectorXd with_error(std::size_t axis, double scale, double bias) const {
    SixAxisRows rows = rows_;
    for (std::size_t i = axis; i < rows.velocities.size(); i += kSixAxes) {
      rows.velocities[i] += scale * rows.velocities[i] + bias;
    }
    Search other(rows, *this);
    return other.iterate(true) ? other.best_.parameters : best_.parameters;
  }

  double usual_step_s() const {
    std::vector<double> steps;
    for (std::size_t row = 1; row < rows_.rows(); ++row) {
      steps.push_back(rows_.times_s[row] - rows_.times_s[row - 1]);
    }
    return quantile(steps, 0.5);
  }

  // Further standard errors, of what no log tells.
  double allowance(std::size_t place) const {
    if (place == SixAxisPlace::moment || place == SixAxisPlace::moment + 1) {
      return kIdentification.attitude_bias_rad *
             std::abs(best_.parameters(place_of(SixAxisPlace::moment + 2)));
    }
    const std::size_t curve = SixAxisPlace::curve(rows_.thrusters.size());
    return place == curve || place == curve + 1 ? usual_step_s() / std::sqrt(12.0) : 0.0;
  }

  const SixAxisRows& rows_;
  SixAxisStructure structure_;
  Eigen::MatrixXd arms_;
  WindowShape shape_;
  ThrustCurve curve_;
  std::array<bool, SixAxisPlace::curve_size> active_{};
  WeakRows weak_;
  FreeFit free_;
  MinimumDistance best_;
  SandwichErrors errors_;
};

SixAxisFit Search::collected() const {
  SixAxisFit fit;
  fit.thrusters = rows_.thrusters;
  fit.curve = curve_;
  fit.windows = static_cast<std::size_t>(weak_.terms.rows());
  fit.window_s = 2.0 * shape_.half_s;
  fit.misfit = std::max(1.0, best_.distance / std::max(errors_.expected_distance,
                                                       std::numeric_limits<double>::min()));
  const std::vector<std::string> names = names_of(rows_.thrusters);
  const Eigen::Index terms = place_of(structure_.terms().size());
  fit.free_terms = Matrix(static_cast<std::size_t>(terms), kSixAxes);
  as_matrix(fit.free_terms) = free_.coefficients.topRows(terms);
  fit.covariance = Matrix(names.size(), names.size());
  auto covariance = as_matrix(fit.covariance);
  const double student = kIdentification.student90 / kNormal90;
  covariance(best_.free, best_.free) =
      student * student * fit.misfit * errors_.covariance + velocity_covariance();
  const Eigen::VectorXd blur = blurs(errors_.covariance);
  const std::size_t curve = SixAxisPlace::curve(rows_.thrusters.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto found = std::ranges::find(best_.free, place_of(i));
    const bool is_sought = found != best_.free.end();
    const double value = i >= curve ? fit.curve.*kCurve[i - curve] : best_.parameters(place_of(i));
    if (is_sought) {
      covariance(place_of(i), place_of(i)) += std::pow(allowance(i), 2.0);
    }
    const ParameterState state =
        i == SixAxisPlace::inertia ? ParameterState::known
        : !is_sought || blur(found - best_.free.begin()) > kIdentification.most_blur
            ? ParameterState::not_told
        : best_.at_bound[i] ? ParameterState::at_bound
                            : ParameterState::identified;
    fit.parameters.push_back(
        {names[i], value, std::sqrt(covariance(place_of(i), place_of(i))), state, i < curve});
  }
  return fit;
}

void require_inertias(const SixAxisFit& fit) {
  std::vector<std::string> missing;
  for (std::size_t axis = 1; axis < kSixAxes; ++axis) {
    const FittedParameter& inertia = fit.parameters[SixAxisPlace::inertia + axis];
    if (inertia.state != ParameterState::identified) {
      missing.push_back(inertia.name);
    }
  }
  if (!missing.empty()) {
    throw InputError(
        "too little excitation to tell " + join_text(missing, ", ") +
        "; it takes a log in which all six axes speed up and slow down; fewer axes can "
        "be identified in the plane, from surge, sway and yaw alone");
  }
}

SixVector as_array(const Eigen::VectorXd& values) {
  SixVector array{};
  std::copy_n(values.data(), kSixAxes, array.begin());
  return array;
}

Eigen::VectorXd terms_at(const MotionTerms& terms, std::span<const double, kSixAxes> velocity,
                         std::span<const double, 3> down, std::span<const double> speeds) {
  std::vector<double> inputs(velocity.begin(), velocity.end());
  inputs.insert(inputs.end(), down.begin(), down.end());
  inputs.insert(inputs.end(), speeds.begin(), speeds.end());
  Eigen::VectorXd values(place_of(terms.size()));
  terms.evaluate(inputs, std::span(values.data(), terms.size()));
  return values;
}

}  // namespace

std::vector<double> thruster_speeds(const SixAxisRows& rows, const ThrustCurve& curve) {
  const std::size_t count = rows.thrusters.size();
  const Actuator actuator{
      .dead_band = curve.dead_band, .lag_s = curve.lag_s, .delay_s = curve.delay_s};
  std::vector<double> speeds(rows.rows() * count);
  const double span_s = rows.rows() > 1 ? rows.times_s.back() - rows.times_s.front() : 1.0;
  const double rate_hz = std::max(1e-3, static_cast<double>(rows.rows()) / std::max(span_s, 1e-9));
  for (std::size_t i = 0; i < count; ++i) {
    ActuatorState state(actuator, rate_hz);
    std::size_t stretch = 0;
    for (std::size_t row = 0; row < rows.rows(); ++row) {
      if (stretch < rows.starts.size() && row == rows.starts[stretch]) {
        state.rest();
        ++stretch;
      }
      const double factor =
          rows.volts.empty() ? 1.0
                             : std::pow(rows.volts[row] / rows.nominal_volts, 0.5 * curve.exponent);
      speeds[row * count + i] = state.next(rows.commands[row * count + i], rows.times_s[row]) /
                                (1.0 - curve.dead_band) * factor;
    }
  }
  return speeds;
}

SixVector SixAxisFit::acceleration(std::span<const double, kSixAxes> velocity,
                                   std::span<const double, 3> down,
                                   std::span<const double> speeds) const {
  const SixAxisStructure structure(thrusters);
  Eigen::VectorXd values(structure.parameters());
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    values(i) = parameters[static_cast<std::size_t>(i)].value;
  }
  const Eigen::VectorXd terms = terms_at(structure.terms(), velocity, down, speeds);
  return as_array(
      structure.mass(values).fullPivLu().solve(structure.forces(values, terms.size()) * terms));
}

SixVector SixAxisFit::free_acceleration(std::span<const double, kSixAxes> velocity,
                                        std::span<const double, 3> down,
                                        std::span<const double> speeds) const {
  const MotionTerms terms = MotionTerms::spatial(thrusters.size());
  return as_array(as_matrix(free_terms).transpose() * terms_at(terms, velocity, down, speeds));
}

SixAxisFit fit_six_axes(const SixAxisRows& rows, const SixAxisSettings& options) {
  std::optional<Search> best;
  double least = std::numeric_limits<double>::infinity();
  SixAxisSettings from = options;
  for (const double half_s : kIdentification.half_windows_s) {
    Search search(rows, from, half_s);
    if (search.run() && search.log_errors() < least) {
      least = search.log_errors();
      from.start = search.curve();  // near the next one's
      best.emplace(std::move(search));
    }
  }
  if (!best) {
    throw InputError(
        "too few rows: six axes take " +
        std::to_string(static_cast<int>(kIdentification.windows_per_term *
                                        static_cast<double>(60 + 2 * rows.thrusters.size()))) +
        " windows of 0.5 to 8 s without a gap, with five rows or more each");
  }
  SixAxisFit fit = best->collected();
  require_inertias(fit);
  return fit;
}

}  // namespace kelpie
