// SPDX-License-Identifier: Apache-2.0
#include "identify/six_axis_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/decomposition.hpp"
#include "core/eigen.hpp"
#include "core/normal_equations.hpp"
#include "core/quantile.hpp"
#include "core/text.hpp"
#include "identify/expected_six_axis_fit.hpp"
#include "identify/minimum_distance.hpp"
#include "identify/planar_estimate.hpp"
#include "identify/six_axis_structure.hpp"
#include "identify/six_axis_windows.hpp"
#include "identify/tuning.hpp"
#include "identify/weak_form.hpp"
#include "kelpie/alignment/alignment.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie {
namespace {

// Names and kinds, in the order of SixAxisPlace.
std::vector<FittedParameter> six_axis_parameters(const std::vector<PlacedThruster>& thrusters) {
  using enum ParameterKind;
  std::vector<std::pair<std::string, ParameterKind>> named;
  const auto add_axes = [&](const char* name, ParameterKind kind) {
    for (const char* const axis : {"surge", "sway", "heave", "roll", "pitch", "yaw"}) {
      named.emplace_back(axis + std::string(name), kind);
    }
  };
  add_axes("_inertia", inertia);
  named.insert(named.end(), {{"low_centre", coupling}, {"forward_centre", coupling}});
  add_axes("_linear_drag", size);
  add_axes("_quadratic_drag", size);
  named.insert(named.end(), {{"net_weight", offset},
                             {"roll_moment", offset},
                             {"pitch_moment", offset},
                             {"righting_moment", size}});
  for (const PlacedThruster& thruster : thrusters) {
    named.emplace_back(thruster.name + ".forward", size);
    named.emplace_back(thruster.name + ".reverse", size);
  }
  for (const char* const name : {"lag", "delay", "dead_band", "volts_exponent"}) {
    named.emplace_back(std::string("thrusters.") + name, curve);
  }
  return unknown_parameters(named);
}

// Gaps between stretches are no steps. 1 s without a step.
double usual_step_s(const SixAxisRows& rows) {
  std::vector<double> steps_s;
  for (std::size_t row = 1; row < rows.rows(); ++row) {
    if (!std::ranges::binary_search(rows.starts, row)) {
      steps_s.push_back(rows.times_s[row] - rows.times_s[row - 1]);
    }
  }
  return steps_s.empty() ? 1.0 : std::max(quantile(steps_s, 0.5), 1e-6);
}

// One fit at one length of window.
class Search {
 public:
  Search(const SixAxisRows& rows, const SixAxisSettings& options, double half_s)
      : rows_(rows),
        structure_(rows.thrusters),
        windows_{.shape = {.half_s = half_s, .stride_s = kIdentification.stride_share * half_s},
                 .curve = options.start,
                 .sought = {options.find_times, options.find_times, true, has_volts(rows)}} {
    if (!windows_.sought[3]) {
      windows_.curve.exponent = 0.0;
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

  bool explains() const {
    return std::isfinite(misfit_of(best_, errors_)) &&
           unexplained_share(free_, best_) <= kIdentification.most_unexplained;
  }
  bool found() const { return explains() && best_.converged; }

  const SixAxisWindows& windows() const { return windows_; }
  const WeakRows& weak() const { return weak_; }
  const FreeFit& free() const { return free_; }
  const MinimumDistance& best() const { return best_; }
  const Eigen::MatrixXd& covariance() const { return errors_.covariance; }  // by chance
  SixAxisFit collected() const;

 private:
  // The same windows and thrust curve over other rows.
  Search(const SixAxisRows& rows, const Search& like)
      : rows_(rows), structure_(rows.thrusters), windows_(like.windows_), best_(like.best_) {}

  static bool has_volts(const SixAxisRows& rows) {
    if (rows.volts.empty()) {
      return false;
    }
    const auto [least, most] = std::ranges::minmax_element(rows.volts);
    return *most > kIdentification.least_volts_ratio * *least;
  }

  bool iterate(bool with_curve) {
    weak_ = with_curve ? weak_rows(rows_, structure_, windows_, best_.parameters)
                       : weak_rows(rows_, structure_, windows_);
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
    for (std::size_t k = 0; with_curve && k < kThrustCurve.size(); ++k) {
      if (windows_.sought[k]) {
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
        windows_.sought[static_cast<std::size_t>(k)] = false;
        best_.parameters(first + k) = 0.0;
      }
    }
  }

  // A step of the curve; whether it was of any size.
  bool move() {
    bool moved = false;
    const Eigen::Index first = place_of(SixAxisPlace::curve(rows_.thrusters.size()));
    for (std::size_t k = 0; k < kThrustCurve.size(); ++k) {
      if (windows_.sought[k]) {
        const double most_step = kIdentification.most_curve_steps[k];
        const double step =
            std::clamp(best_.parameters(first + place_of(k)), -most_step, most_step);
        double& value = windows_.curve.*kThrustCurve[k];
        value = std::clamp(value + step, 0.0, kIdentification.most_of_curve[k]);
        moved = moved || std::abs(step) > kIdentification.least_curve_step * most_step;
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

  // Further standard errors, of what no log tells.
  double allowance(std::size_t place) const {
    if (place == SixAxisPlace::moment || place == SixAxisPlace::moment + 1) {
      return kIdentification.attitude_bias_rad *
             std::abs(best_.parameters(place_of(SixAxisPlace::moment + 2)));
    }
    const std::size_t curve = SixAxisPlace::curve(rows_.thrusters.size());
    return place == curve || place == curve + 1 ? usual_step_s(rows_) / std::sqrt(12.0) : 0.0;
  }

  const SixAxisRows& rows_;
  SixAxisStructure structure_;
  SixAxisWindows windows_;
  WeakRows weak_;
  FreeFit free_;
  MinimumDistance best_;
  SandwichErrors errors_;
};

SixAxisFit Search::collected() const {
  SixAxisFit fit;
  fit.thrusters = rows_.thrusters;
  fit.curve = windows_.curve;
  fit.windows = static_cast<std::size_t>(weak_.terms.rows());
  fit.window_s = 2.0 * windows_.shape.half_s;
  fit.misfit = misfit_of(best_, errors_);
  fit.parameters = six_axis_parameters(rows_.thrusters);
  const Eigen::Index terms = place_of(structure_.terms().size());
  fit.free_terms = Matrix(static_cast<std::size_t>(terms), kSixAxes);
  as_matrix(fit.free_terms) = free_.coefficients.topRows(terms);
  fit.covariance = Matrix(fit.parameters.size(), fit.parameters.size());
  auto covariance = as_matrix(fit.covariance);
  covariance(best_.free, best_.free) =
      kStudent * kStudent * fit.misfit * errors_.covariance + velocity_covariance();
  const Eigen::VectorXd blur = blurs(errors_.covariance);
  const std::size_t curve = SixAxisPlace::curve(rows_.thrusters.size());
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    FittedParameter& parameter = fit.parameters[i];
    const auto found = std::ranges::find(best_.free, place_of(i));
    const bool is_sought = found != best_.free.end();
    parameter.value =
        i >= curve ? fit.curve.*kThrustCurve[i - curve] : best_.parameters(place_of(i));
    if (is_sought) {
      covariance(place_of(i), place_of(i)) += std::pow(allowance(i), 2.0);
    }
    parameter.error = std::sqrt(covariance(place_of(i), place_of(i)));
    parameter.state = i == SixAxisPlace::inertia ? ParameterState::known
                      : !is_sought || blur(found - best_.free.begin()) > kIdentification.most_blur
                          ? ParameterState::not_told
                      : best_.at_bound[i] ? ParameterState::at_bound
                                          : ParameterState::identified;
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

// Thrusters that ran, and would have to push backwards.
std::vector<std::size_t> thrusters_at_rest(const Search& search, const SixAxisFit& fit) {
  std::vector<std::size_t> at_rest;
  for (std::size_t i = 0; i < fit.thrusters.size(); ++i) {
    const std::size_t place = SixAxisPlace::thruster(i);
    const bool ran =
        std::ranges::find(search.best().free, place_of(place)) != search.best().free.end();
    if (ran && fit.parameters[place].value == 0.0 && fit.parameters[place + 1].value == 0.0) {
      at_rest.push_back(i);
    }
  }
  return at_rest;
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

// The search of the window with the least errors, of those that found a vehicle, if any.
Search best_search(const SixAxisRows& rows, const SixAxisSettings& options) {
  std::optional<Search> best;
  double least = std::numeric_limits<double>::infinity();
  SixAxisSettings from = options;
  for (const double half_s : kIdentification.half_windows_s) {
    Search search(rows, from, half_s);
    if (!search.run()) {
      continue;
    }
    const bool is_first = !best || (search.found() && !best->found());
    if (is_first || (search.found() == best->found() && search.log_errors() < least)) {
      least = search.log_errors();
      if (search.found()) {
        from.start = search.windows().curve;  // near the next one's
      }
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
  return *std::move(best);
}

// One thruster the other way round takes the thrust of others with it.
std::string reversed_text(const SixAxisRows& rows, const SixAxisSettings& options, double half_s,
                          const std::vector<std::size_t>& at_rest) {
  for (const std::size_t thruster : at_rest) {
    SixAxisRows turned = rows;
    for (double& part : turned.thrusters[thruster].direction) {
      part = -part;
    }
    if (Search search(turned, options, half_s); search.run() && search.found()) {
      return "; the log is explained with the direction of " + rows.thrusters[thruster].name +
             " reversed";
    }
  }
  return "";
}

// The parameters of the search, where they are those of a vehicle.
SixAxisFit checked(const Search& search, const SixAxisRows& rows, const SixAxisSettings& options) {
  SixAxisFit fit = search.collected();
  const bool explains = search.explains();
  if (explains) {
    require_inertias(fit);
  }
  if (!search.found()) {
    const std::vector<std::size_t> at_rest = thrusters_at_rest(search, fit);
    std::vector<std::string> names;
    for (const std::size_t thruster : at_rest) {
      names.push_back(rows.thrusters[thruster].name);
    }
    throw InputError(
        std::string(explains ? "the fit settles on no vehicle with these thrusters"
                             : "no vehicle with these thrusters explains the log") +
        (names.empty() ? std::string() : " (no thrust of " + join_text(names, ", ") + ")") +
        reversed_text(rows, options, search.windows().shape.half_s, at_rest) +
        "; check places and directions of the thrusters, and signs and units of commands, "
        "velocities and angles");
  }
  return fit;
}

// What was never seen: a thruster counts as alike both ways.
void complete(const std::vector<Eigen::Index>& free, std::size_t thrusters, SixAxisFit& fit,
              Eigen::VectorXd& parameters) {
  for (std::size_t i = 0; i < 2 * thrusters; ++i) {
    const std::size_t place = SixAxisPlace::thrusters + i;
    if (std::ranges::find(free, place_of(place)) == free.end()) {
      parameters(place_of(place)) = parameters(place_of(SixAxisPlace::thrusters + (i ^ 1U)));
      fit.parameters[place].value = parameters(place_of(place));
    }
  }
}

void set_errors(const Eigen::MatrixXd& covariance, ParameterFit& fit) {
  as_matrix(fit.covariance) = covariance;
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    fit.parameters[i].error = std::sqrt(covariance(place_of(i), place_of(i)));
  }
}

}  // namespace

std::vector<double> thruster_speeds(const SixAxisRows& rows, const ThrustCurve& curve) {
  const std::size_t count = rows.thrusters.size();
  const Actuator actuator{
      .dead_band = curve.dead_band, .lag_s = curve.lag_s, .delay_s = curve.delay_s};
  std::vector<double> speeds(rows.rows() * count);
  const double rate = 1.0 / usual_step_s(rows);
  for (std::size_t i = 0; i < count; ++i) {
    ActuatorState state(actuator, rate);
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

SixAxisVehicle::SixAxisVehicle(const SixAxisFit& fit)
    : terms_(MotionTerms::spatial(fit.thrusters.size())) {
  const SixAxisStructure structure(fit.thrusters);
  Eigen::VectorXd values(structure.parameters());
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    values(i) = fit.parameters[static_cast<std::size_t>(i)].value;
  }
  forces_ = structure.forces(values, place_of(terms_.size()));
  mass_ = PivotedFactor(structure.mass(values));
}

SixVector SixAxisVehicle::acceleration(std::span<const double, kSixAxes> velocity,
                                       std::span<const double, 3> down,
                                       std::span<const double> speeds) const {
  return as_array(
      mass_->solve(Eigen::VectorXd(forces_ * terms_at(terms_, velocity, down, speeds))));
}

SixVector SixAxisFit::acceleration(std::span<const double, kSixAxes> velocity,
                                   std::span<const double, 3> down,
                                   std::span<const double> speeds) const {
  return SixAxisVehicle(*this).acceleration(velocity, down, speeds);
}

SixVector SixAxisFit::free_acceleration(std::span<const double, kSixAxes> velocity,
                                        std::span<const double, 3> down,
                                        std::span<const double> speeds) const {
  const MotionTerms terms = MotionTerms::spatial(thrusters.size());
  return as_array(as_matrix(free_terms).transpose() * terms_at(terms, velocity, down, speeds));
}

SixAxisFit fit_six_axes(const SixAxisRows& rows, const SixAxisSettings& options) {
  return checked(best_search(rows, options), rows, options);
}

ExpectedSixAxisFit::ExpectedSixAxisFit(const SixAxisRows& rows, const SixAxisSettings& options)
    : structure_(rows.thrusters) {
  const Search search = best_search(rows, options);
  now_ = checked(search, rows, options);
  misfit_ = now_.misfit;
  windows_ = search.windows();
  parameters_ = search.best().parameters;
  parameters_.tail(place_of(SixAxisPlace::curve_size)).setZero();
  complete(search.best().free, rows.thrusters.size(), now_, parameters_);
  const std::vector<Eigen::Index>& free = search.best().free;
  floor_ = as_matrix(now_.covariance);
  floor_(free, free) -= kStudent * kStudent * misfit_ * search.covariance();
  const Eigen::Index terms = search.weak().terms.cols();
  const Eigen::MatrixXd mass = structure_.mass(parameters_);
  const Eigen::MatrixXd coefficients =
      PivotedFactor(mass).solve(structure_.forces(parameters_, terms)).transpose();
  const Eigen::MatrixXd jacobian = structure_.residual(coefficients, parameters_).jacobian;
  const Eigen::MatrixXd metric =
      equilibrated_inverse(mass * search.free().noise * mass.transpose());
  const Eigen::MatrixXd by_scores = metric * mass;
  for (Eigen::Index axis = 0; axis < 6; ++axis) {
    slopes_.emplace_back(jacobian(Eigen::seqN(axis, terms, 6), Eigen::all));
  }
  for (Eigen::Index axis = 0; axis < 6; ++axis) {
    weighted_.emplace_back(Eigen::MatrixXd::Zero(terms, jacobian.cols()));
    by_scores_.push_back(weighted_.back());
    for (Eigen::Index other = 0; other < 6; ++other) {
      weighted_.back() += metric(axis, other) * slopes_[static_cast<std::size_t>(other)];
      by_scores_.back() += by_scores(other, axis) * slopes_[static_cast<std::size_t>(other)];
    }
  }
  noise_ = window_noise(search.weak(), search.free(), windows_.shape);
  told_ = information(search.free().gram, search.weak().terms);
  const Eigen::MatrixXd expected = covariance_of(told_);
  const double factor =
      std::max(1.0, median_ratio(as_matrix(now_.covariance)(free, free), expected(free, free)));
  for (Eigen::VectorXd& covariance : noise_.autocovariance) {
    covariance *= factor;
  }
  told_.gradients *= factor;
  set_errors(covariance_of(told_), now_);
}

ParameterFit ExpectedSixAxisFit::after(const WeakRows& drives) const {
  ParameterFit fit = now_;
  if (drives.terms.rows() > 0) {
    Information told = information(drives);
    told.hessian += told_.hessian;
    told.gradients += told_.gradients;
    set_errors(covariance_of(told), fit);
  }
  return fit;
}

WeakRows ExpectedSixAxisFit::windows(const SixAxisRows& drives) const {
  return weak_rows(drives, structure_, windows_, parameters_);
}

ExpectedFit::Information ExpectedSixAxisFit::information(const WeakRows& drives) const {
  return information(drives.terms.transpose() * drives.terms, drives.terms);
}

// For coefficients on the structure: H = Σ_a J_aᵀ G (N⁻¹ J)_a, Σ_a ((N⁻¹M)ᵀJ)_aᵀ S_a ((N⁻¹M)ᵀJ)_a,
// distance_hessian() and gradient_covariance() without matrices of axes · terms.
ExpectedFit::Information ExpectedSixAxisFit::information(const Eigen::MatrixXd& gram,
                                                         const Eigen::MatrixXd& terms) const {
  const std::vector<Eigen::MatrixXd> scores = expected_axis_scores(terms, noise_);
  const Eigen::Index count = parameters_.size();
  Information told{Eigen::MatrixXd::Zero(count, count), Eigen::MatrixXd::Zero(count, count)};
  for (std::size_t axis = 0; axis < kSixAxes; ++axis) {
    told.hessian += slopes_[axis].transpose() * (gram * weighted_[axis]);
    told.gradients += by_scores_[axis].transpose() * (scores[axis] * by_scores_[axis]);
  }
  return told;
}

Eigen::MatrixXd ExpectedSixAxisFit::covariance_of(const Information& told) const {
  std::vector<Eigen::Index> sought;
  for (Eigen::Index place = 1; place < parameters_.size(); ++place) {
    if (told.hessian(place, place) > 0.0) {
      sought.push_back(place);
    }
  }
  Eigen::MatrixXd covariance = floor_;
  for (Eigen::Index place = 1; place < parameters_.size(); ++place) {
    covariance(place, place) += std::pow(kIdentification.unseen * parameters_(place), 2.0);
  }
  const Eigen::MatrixXd inverse = equilibrated_inverse(told.hessian(sought, sought));
  covariance(sought, sought) = floor_(sought, sought) + kStudent * kStudent * misfit_ * inverse *
                                                            told.gradients(sought, sought) *
                                                            inverse;
  return covariance;
}

}  // namespace kelpie
