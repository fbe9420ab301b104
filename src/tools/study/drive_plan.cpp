// SPDX-License-Identifier: Apache-2.0
#include "study/drive_plan.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/angle.hpp"
#include "core/eigen.hpp"
#include "core/quantile.hpp"
#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "motion/tuning.hpp"
#include "motion/weak_form.hpp"

namespace kelpie::study {
namespace {

constexpr int kSubsteps = 5;            // of the integration in a step of commands
constexpr std::size_t kDraws = 12;      // vehicles besides the estimate
constexpr double kUnknownShare = 0.3;   // of a parameter that is not told
constexpr double kCoastS = 6.0;         // after a drive, thrusters off
constexpr const char* kLoad = "load";   // a change of all inertias
constexpr double kMostTurnsPerS = 1.0;  // of a plausible vehicle

void advance_by(const PlanarVehicle& vehicle, std::span<const double> speeds, double dt,
                PlanarMotion& motion) {
  const PlanarVector slope = vehicle.acceleration(motion.velocity, speeds);
  PlanarVector middle = motion.velocity;
  for (std::size_t axis = 0; axis < kPlanarAxes; ++axis) {
    middle[axis] += 0.5 * dt * slope[axis];
  }
  const PlanarVector better = vehicle.acceleration(middle, speeds);
  for (std::size_t axis = 0; axis < kPlanarAxes; ++axis) {
    motion.velocity[axis] += dt * better[axis];
  }
  const double heading = motion.heading_rad + 0.5 * dt * middle[2];
  motion.x_m += dt * (middle[0] * std::cos(heading) - middle[1] * std::sin(heading));
  motion.y_m += dt * (middle[0] * std::sin(heading) + middle[1] * std::cos(heading));
  motion.heading_rad += dt * middle[2];
}

bool is_told(const FittedParameter& parameter) {
  return parameter.state == ParameterState::identified || parameter.state == ParameterState::known;
}

// A matrix whose product with standard normal numbers has the errors of the fit.
Eigen::MatrixXd root_of_errors(const PlanarFit& fit) {
  Eigen::MatrixXd covariance = as_matrix(fit.covariance);
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    const FittedParameter& parameter = fit.parameters[i];
    const auto place = static_cast<Eigen::Index>(i);
    const double most = kUnknownShare * std::abs(parameter.value);
    if (!is_told(parameter) && parameter.error > most) {
      covariance.row(place) *= most / parameter.error;
      covariance.col(place) *= most / parameter.error;
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

bool is_size(std::size_t place) {
  const bool is_force =
      place >= PlanarPlace::constant_force && place < PlanarPlace::constant_force + kPlanarAxes;
  const bool is_direction = place >= PlanarPlace::thrusters &&
                            (place - PlanarPlace::thrusters) % PlanarPlace::per_thruster >= 2;
  return !is_force && !is_direction && place != PlanarPlace::sway_yaw_inertia;
}

bool is_usual(std::size_t place) {
  const bool is_angle = place >= PlanarPlace::thrusters &&
                        (place - PlanarPlace::thrusters) % PlanarPlace::per_thruster == 2;
  const bool is_force =
      place >= PlanarPlace::constant_force && place < PlanarPlace::constant_force + kPlanarAxes;
  return !is_angle && !is_force && place != PlanarPlace::sway_yaw_inertia;
}

std::vector<std::string> words_of(const std::string& name) {
  std::vector<std::string> words(1);
  for (const char letter : name) {
    if (letter == '_' || letter == '.') {
      words.emplace_back();
    } else {
      words.back() += letter;
    }
  }
  return words;
}

bool has_words(const std::string& name, const std::string& wanted) {
  const std::vector<std::string> words = words_of(name);
  return std::ranges::all_of(words_of(wanted), [&](const std::string& word) {
    return std::ranges::find(words, word) != words.end();
  });
}

PlanarVehicle drawn_vehicle(const PlanarFit& fit, const Eigen::MatrixXd& root,
                            RandomStream& random) {
  Eigen::VectorXd normal(root.cols());
  for (double& value : normal) {
    value = random.normal();
  }
  const Eigen::VectorXd change = root * normal;
  PlanarFit other = fit;
  for (std::size_t i = 0; i < other.parameters.size(); ++i) {
    double& value = other.parameters[i].value;
    const double moved = value + change(static_cast<Eigen::Index>(i));
    value = is_size(i) ? std::max(moved, 0.3 * value) : moved;
  }
  return other.vehicle();
}

// Rows of the estimate under way, and the windows of the whole drive so far.
class DriveRecord {
 public:
  DriveRecord(PlanarVehicle vehicle, double row_s, const PlanarMotion& start)
      : vehicle_(std::move(vehicle)), row_s_(row_s), motion_(start) {
    for (const PlanarThruster& thruster : vehicle_.thrusters) {
      rows_.thrusters.push_back(thruster.name);
    }
  }

  void add(const Manoeuvre& manoeuvre) {
    for (const HeldSpeeds& part : manoeuvre.parts) {
      const auto count = static_cast<int>(std::lround(part.duration_s / kManoeuvreStepS));
      for (int step = 0; step < count; ++step) {
        add_step(part.speeds);
      }
    }
  }

  WeakRows windows() const { return weak_rows(rows_, {}); }
  const std::vector<double>& x_m() const { return x_m_; }
  const std::vector<double>& y_m() const { return y_m_; }

 private:
  void add_step(const std::vector<double>& speeds) {
    x_m_.push_back(motion_.x_m);
    y_m_.push_back(motion_.y_m);
    const auto parts = std::max(1, static_cast<int>(std::lround(kManoeuvreStepS / row_s_)));
    const double dt = kManoeuvreStepS / parts;
    const int substeps = std::max(1, kSubsteps / parts);
    for (int row = 0; row < parts; ++row) {
      rows_.times_s.push_back(time_s_);
      rows_.velocities.insert(rows_.velocities.end(), motion_.velocity.begin(),
                              motion_.velocity.end());
      rows_.speeds.insert(rows_.speeds.end(), speeds.begin(), speeds.end());
      for (int i = 0; i < substeps; ++i) {
        advance_by(vehicle_, speeds, dt / substeps, motion_);
      }
      time_s_ += dt;
    }
  }

  PlanarVehicle vehicle_;
  double row_s_;
  PlanarMotion motion_;
  PlanarRows rows_;
  std::vector<double> x_m_, y_m_;
  double time_s_ = 0.0;
};

// A change by `share`: of a thruster's thrust, of all inertias ("load"), else of what has the
// words.
std::vector<double> change_of(const PlanarFit& fit, const std::string& cause, double share) {
  std::vector<double> change(fit.parameters.size(), 0.0);
  for (std::size_t i = 0; i < change.size(); ++i) {
    const bool is_inertia = i < PlanarPlace::linear_drag;
    const bool is_wanted =
        cause == kLoad ? is_inertia : is_size(i) && has_words(fit.parameters[i].name, cause);
    change[i] = is_wanted ? share * fit.parameters[i].value : 0.0;
  }
  if (std::ranges::all_of(change, [](double value) { return value == 0.0; })) {
    throw InputError("--apart", "'" + cause +
                                    "' changes nothing that is known; a cause is a thruster of "
                                    "the log, drag, surge_drag, sway_drag, yaw_drag or load");
  }
  return change;
}

// The best next manoeuvre, and what is known after it.
struct DriveChoice {
  double gain = 0.0;
  const Manoeuvre* manoeuvre = nullptr;
  DriveProgress progress{};
};

}  // namespace

PossibleVehicles::PossibleVehicles(const PlanarFit& fit, const DriveBounds& bounds,
                                   const PlanarMotion& start)
    : bounds_(bounds), vehicles_{fit.vehicle()}, motions_(1 + kDraws, start) {
  const Eigen::MatrixXd root = root_of_errors(fit);
  RandomStream random(1, "possible vehicles");
  while (vehicles_.size() < motions_.size()) {
    vehicles_.push_back(drawn_vehicle(fit, root, random));
  }
}

bool PossibleVehicles::advance(const Manoeuvre& manoeuvre, std::vector<PlanarMotion>& motions,
                               double& farthest_m, double& fastest_m_s) const {
  const auto keeps = [&](std::size_t i, PlanarMotion& motion, const HeldSpeeds& part) {
    const auto steps = static_cast<int>(std::lround(kSubsteps * part.duration_s / kManoeuvreStepS));
    for (int step = 0; step < steps; ++step) {
      advance_by(vehicles_[i], part.speeds, kManoeuvreStepS / kSubsteps, motion);
      farthest_m = std::max(farthest_m, std::hypot(motion.x_m, motion.y_m));
      fastest_m_s = std::max(fastest_m_s, std::hypot(motion.velocity[0], motion.velocity[1]));
      if (!(farthest_m <= bounds_.radius_m && fastest_m_s <= bounds_.speed_m_s &&
            std::abs(motion.velocity[2]) < kFullTurn * kMostTurnsPerS)) {
        return false;
      }
    }
    return true;
  };
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    for (const HeldSpeeds& part : manoeuvre.parts) {
      if (!keeps(i, motions[i], part)) {
        return false;
      }
    }
    PlanarMotion coasting = motions[i];
    const std::vector<double> off(manoeuvre.parts.front().speeds.size(), 0.0);
    if (!keeps(i, coasting, {kCoastS, off})) {
      return false;
    }
  }
  return true;
}

bool PossibleVehicles::allows(const Manoeuvre& manoeuvre) const {
  std::vector<PlanarMotion> motions = motions_;
  double farthest_m = 0.0;
  double fastest_m_s = 0.0;
  return advance(manoeuvre, motions, farthest_m, fastest_m_s);
}

bool PossibleVehicles::drive(const Manoeuvre& manoeuvre) {
  std::vector<PlanarMotion> motions = motions_;
  double farthest_m = farthest_m_;
  double fastest_m_s = fastest_m_s_;
  if (!advance(manoeuvre, motions, farthest_m, fastest_m_s)) {
    return false;
  }
  motions_ = std::move(motions);
  farthest_m_ = farthest_m;
  fastest_m_s_ = fastest_m_s;
  return true;
}

double DrivePlan::duration_s() const {
  double sum = 0.0;
  for (const Manoeuvre& manoeuvre : manoeuvres) {
    sum += manoeuvre.duration_s();
  }
  return sum;
}

std::vector<std::size_t> wanted_places(const PlanarFit& fit,
                                       const std::vector<std::string>& names) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    if (fit.parameters[i].state != ParameterState::known && (names.empty() ? is_usual(i) : true) &&
        (names.empty() || std::ranges::any_of(names, [&](const std::string& name) {
           return has_words(fit.parameters[i].name, name);
         }))) {
      places.push_back(i);
    }
  }
  for (const std::string& name : names) {
    std::vector<std::string> known;
    for (const FittedParameter& parameter : fit.parameters) {
      known.push_back(parameter.name);
    }
    if (std::ranges::none_of(known, [&](const std::string& one) { return has_words(one, name); })) {
      throw InputError("--tell", "'" + name + "' is no parameter" + did_you_mean(name, known) +
                                     "; there are " + join_text(known, ", "));
    }
  }
  return places;
}

double interval_share(const PlanarFit& fit, std::size_t place) {
  const FittedParameter& parameter = fit.parameters[place];
  const bool is_angle = place >= PlanarPlace::thrusters &&
                        (place - PlanarPlace::thrusters) % PlanarPlace::per_thruster == 2;
  const double size = is_angle ? 1.0
                      : place == PlanarPlace::sway_yaw_inertia
                          ? std::sqrt(std::abs(fit.parameters[PlanarPlace::sway_inertia].value *
                                               fit.parameters[PlanarPlace::yaw_inertia].value))
                          : std::abs(parameter.value);
  return kNormal90 * parameter.error / std::max(size, 1e-12);
}

DriveGoal telling_goal(const ExpectedPlanarFit& expected, std::vector<std::size_t> parameters,
                       double share, FitScale scale) {
  PlanarFit scaled = expected.now();
  scale(scaled);
  std::erase_if(parameters, [&](std::size_t place) {
    return scaled.parameters[place].state == ParameterState::known;
  });
  require(!parameters.empty(), "--tell", "names no parameter that a drive can tell");
  DriveGoal goal;
  for (const std::size_t place : parameters) {
    goal.names.push_back(expected.now().parameters[place].name);
  }
  goal.progress = [&expected, parameters = std::move(parameters), share,
                   scale = std::move(scale)](const WeakRows& windows) {
    PlanarFit fit = expected.after(windows);
    scale(fit);
    DriveProgress progress{.reached = true};
    for (const std::size_t place : parameters) {
      const double number = interval_share(fit, place);
      progress.numbers.push_back(number);
      progress.missing += std::log1p(std::pow(number / share, 2.0));
      progress.reached = progress.reached && number <= share;
    }
    return progress;
  };
  return goal;
}

DriveGoal parting_goal(const ExpectedPlanarFit& expected, const std::string& first,
                       const std::string& second, double share) {
  std::vector<double> one = change_of(expected.now(), first, share);
  std::vector<double> other = change_of(expected.now(), second, share);
  require(one != other, "--apart", "names the same change twice");
  DriveGoal goal{.names = {first + " or " + second}, .progress = {}};
  goal.progress = [&expected, one = std::move(one),
                   other = std::move(other)](const WeakRows& windows) {
    const double nats = windows.terms.rows() > 0 ? expected.evidence(windows, one, other) : 0.0;
    return DriveProgress{.numbers = {nats},
                         .missing = -std::log1p(nats),
                         .reached = nats >= kDiagnosis.named_margin_nats};
  };
  return goal;
}

DrivePlan plan_drive(const PlanarFit& fit, const PlanarPush& push, const DriveBounds& bounds,
                     const DriveGoal& goal, double row_s, const PlanarMotion& start) {
  const std::vector<Manoeuvre> dictionary = manoeuvres_for(push);
  PossibleVehicles possible(fit, bounds, start);
  DriveRecord record(fit.vehicle(), row_s, start);
  DrivePlan plan{.names = goal.names};
  DriveProgress now = goal.progress(WeakRows{});
  plan.countdown.push_back({0.0, "", now.numbers});
  double t_s = 0.0;
  while (!now.reached) {
    DriveChoice best;
    for (const Manoeuvre& manoeuvre : dictionary) {
      if (t_s + manoeuvre.duration_s() > bounds.time_s + 1e-9 || !possible.allows(manoeuvre)) {
        continue;
      }
      DriveRecord longer = record;
      longer.add(manoeuvre);
      DriveProgress progress = goal.progress(longer.windows());
      const double gain = (now.missing - progress.missing) / manoeuvre.duration_s();
      if (gain > best.gain) {
        best = {gain, &manoeuvre, std::move(progress)};
      }
    }
    if (best.manoeuvre == nullptr) {
      break;
    }
    now = std::move(best.progress);
    possible.drive(*best.manoeuvre);
    record.add(*best.manoeuvre);
    t_s += best.manoeuvre->duration_s();
    plan.manoeuvres.push_back(*best.manoeuvre);
    plan.countdown.push_back({t_s, best.manoeuvre->name, now.numbers});
  }
  plan.reached = now.reached;
  require(plan.reached || !plan.manoeuvres.empty(), "bounds",
          "leave room for no manoeuvre: give more time, speed or space");
  plan.x_m = record.x_m();
  plan.y_m = record.y_m();
  plan.farthest_m = possible.farthest_m();
  plan.fastest_m_s = possible.fastest_m_s();
  return plan;
}

}  // namespace kelpie::study
