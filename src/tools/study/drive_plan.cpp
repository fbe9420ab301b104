// SPDX-License-Identifier: Apache-2.0
#include "study/drive_plan.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/angle.hpp"
#include "core/eigen.hpp"
#include "core/quantile.hpp"
#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "simulator/decomposition.hpp"
#include "study/tuning.hpp"
#include "vehicle/tuning.hpp"

namespace kelpie::study {
namespace {

constexpr double kWrongVehicle = 100.0;  // misfit
constexpr const char* kLoad = "load";    // a change of all inertias
constexpr const char* kAllThrusters = "all_thrusters";

bool is_told(const FittedParameter& parameter) {
  return parameter.state == ParameterState::identified || parameter.state == ParameterState::known;
}

// A matrix whose product with standard normal numbers has the errors of the fit.
Eigen::MatrixXd root_of_errors(const ParameterFit& fit) {
  Eigen::MatrixXd covariance = as_matrix(fit.covariance);
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    const FittedParameter& parameter = fit.parameters[i];
    const auto place = static_cast<Eigen::Index>(i);
    const double most = kTuning.plan.unknown_share * std::abs(parameter.value);
    if (!is_told(parameter) && parameter.error > most) {
      covariance.row(place) *= most / parameter.error;
      covariance.col(place) *= most / parameter.error;
    }
  }
  const simulator::SymmetricPairs pairs = simulator::symmetric_pairs(covariance);
  return pairs.vectors * pairs.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

bool is_size(const FittedParameter& parameter) {
  using enum ParameterKind;
  return parameter.kind == inertia || parameter.kind == size || parameter.kind == curve;
}

bool is_usual(const FittedParameter& parameter) {
  using enum ParameterKind;
  return parameter.kind == inertia || parameter.kind == size || parameter.kind == arm;
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

ParameterFit drawn_fit(const ParameterFit& fit, const Eigen::MatrixXd& root, RandomStream& random) {
  Eigen::VectorXd normal(root.cols());
  for (double& value : normal) {
    value = random.normal();
  }
  const Eigen::VectorXd change = root * normal;
  ParameterFit other = fit;
  for (std::size_t i = 0; i < other.parameters.size(); ++i) {
    double& value = other.parameters[i].value;
    const double moved = value + change(static_cast<Eigen::Index>(i));
    value = is_size(other.parameters[i]) ? std::max(moved, 0.3 * value) : moved;
  }
  return other;
}

// Rows of the estimate under way, and the windows of the whole drive so far.
class DriveRecord {
 public:
  DriveRecord(const DrivableVehicle& vehicle, DriveMotion start)
      : vehicle_(vehicle),
        step_(vehicle.vehicle_of(vehicle.expected().now())),
        motion_(std::move(start)) {}

  void add(const Manoeuvre& manoeuvre) {
    for (const HeldSpeeds& part : manoeuvre.parts) {
      const auto count = static_cast<int>(std::lround(part.duration_s / kManoeuvreStepS));
      for (int step = 0; step < count; ++step) {
        add_step(part.speeds);
      }
    }
  }

  WeakRows windows() const { return vehicle_.windows(rows_); }
  const std::vector<DriveMotion>& track() const { return track_; }

 private:
  void add_step(const std::vector<double>& speeds) {
    track_.push_back(motion_);
    const auto parts =
        std::max(1, static_cast<int>(std::lround(kManoeuvreStepS / vehicle_.row_s())));
    const double dt = kManoeuvreStepS / parts;
    const int substeps = std::max(1, kTuning.plan.substeps / parts);
    for (int row = 0; row < parts; ++row) {
      rows_.times_s.push_back(time_s_);
      rows_.velocities.insert(rows_.velocities.end(), motion_.velocity.begin(),
                              motion_.velocity.end());
      const Triple down = down_at(motion_.angles_rad);
      rows_.down.insert(rows_.down.end(), down.begin(), down.end());
      rows_.commands.insert(rows_.commands.end(), speeds.begin(), speeds.end());
      for (int i = 0; i < substeps; ++i) {
        step_(speeds, dt / substeps, motion_);
      }
      time_s_ += dt;
    }
  }

  const DrivableVehicle& vehicle_;
  DriveStep step_;
  DriveMotion motion_;
  SixAxisRows rows_;
  std::vector<DriveMotion> track_;
  double time_s_ = 0.0;
};

bool is_thrust(const FittedParameter& parameter) {
  return parameter.kind == ParameterKind::size &&
         (parameter.name.ends_with(".forward") || parameter.name.ends_with(".reverse"));
}

bool is_changed(const FittedParameter& parameter, const std::string& cause) {
  using enum ParameterKind;
  if (cause == kLoad) {
    return parameter.kind == inertia || parameter.kind == coupling;
  }
  if (cause == kAllThrusters) {
    return is_thrust(parameter);
  }
  return parameter.kind == offset ? parameter.name == cause
                                  : is_size(parameter) && has_words(parameter.name, cause);
}

// A constant force may be 0: the drag of its axis at 1 m/s or 1 rad/s is its size.
double changed_size(const ParameterFit& fit, const FittedParameter& parameter) {
  if (parameter.kind != ParameterKind::offset) {
    return parameter.value;
  }
  const std::string axis =
      parameter.name == "net_weight" ? "heave" : words_of(parameter.name).front();
  double drag = 0.0;
  for (const FittedParameter& one : fit.parameters) {
    drag += one.name.starts_with(axis + "_") && one.name.ends_with("_drag") ? one.value : 0.0;
  }
  return drag;
}

// A change by `share` of what a cause has.
std::vector<double> change_of(const ParameterFit& fit, const std::string& cause, double share) {
  std::vector<double> change;
  std::vector<std::string> forces;
  for (const FittedParameter& parameter : fit.parameters) {
    change.push_back(is_changed(parameter, cause) ? share * changed_size(fit, parameter) : 0.0);
    if (parameter.kind == ParameterKind::offset) {
      forces.push_back(parameter.name);
    }
  }
  if (std::ranges::all_of(change, [](double value) { return value == 0.0; })) {
    throw InputError("--apart",
                     fmt::format("'{}' changes nothing that is known; a cause is a thruster of the "
                                 "log, {}, drag, surge_drag, sway_drag, yaw_drag, {} or a constant "
                                 "force: {}",
                                 cause, kAllThrusters, kLoad, join_text(forces, ", ")));
  }
  return change;
}

// What the errors of a parameter are compared with.
double size_of(const ParameterFit& fit, const FittedParameter& parameter) {
  const auto value = [&](const char* name) {
    return std::ranges::find(fit.parameters, name, &FittedParameter::name)->value;
  };
  const std::string& name = parameter.name;
  switch (parameter.kind) {
    case ParameterKind::angle:
      return 1.0;
    case ParameterKind::coupling:
      return name == "low_centre"
                 ? std::sqrt(std::abs(value("surge_inertia") * value("pitch_inertia")))
                 : std::sqrt(std::abs(value("sway_inertia") * value("yaw_inertia")));
    case ParameterKind::curve:
      return name.ends_with(".lag") ? std::abs(parameter.value) : 1.0;
    default:
      break;
  }
  return std::abs(name == "roll_moment" || name == "pitch_moment" ? value("righting_moment")
                                                                  : parameter.value);
}

// The best next manoeuvre, and what is known after it.
struct DriveChoice {
  double gain = 0.0;  // per second
  Manoeuvre manoeuvre{};
  DriveProgress progress{};
};

// Candidates for the next manoeuvre. In the plane the dictionary. On six axes fresh draws at every
// choice, as strong as the bounds allow: pushes of several axes at once tell more per second than
// pushes of a single axis, and bounds of tilt depend on the motion so far.
class Candidates {
 public:
  explicit Candidates(const ThrusterPush& push)
      : push_(push),
        draws_(push),
        dictionary_(push.axes() == kPlanarAxes ? manoeuvres_for(push) : std::vector<Manoeuvre>{}) {}

  std::vector<Manoeuvre> next(const PossibleVehicles& possible) {
    if (!dictionary_.empty()) {
      return dictionary_;
    }
    std::vector<Manoeuvre> list;
    for (std::size_t i = 0; i < kTuning.plan.candidates; ++i) {
      add_strongest(draws_.next(), possible, list);
    }
    return list;
  }

 private:
  void add_strongest(const Manoeuvre& draw, const PossibleVehicles& possible,
                     std::vector<Manoeuvre>& list) const {
    for (double share = 1.0; share > kTuning.plan.softest; share *= kTuning.plan.softer) {
      Manoeuvre manoeuvre = at_amplitude(draw, share, push_);
      if (possible.allows(manoeuvre)) {
        list.push_back(std::move(manoeuvre));
        return;
      }
    }
  }

  const ThrusterPush& push_;
  ManoeuvreDraws draws_;
  std::vector<Manoeuvre> dictionary_;
};

// The candidate with the largest gain, of those that the bounds allow.
DriveChoice best_of(std::vector<Manoeuvre> candidates, const DriveRecord& record,
                    const PossibleVehicles& possible, const DriveGoal& goal,
                    const DriveProgress& now, double left_s) {
  DriveChoice best;
  for (Manoeuvre& manoeuvre : candidates) {
    if (manoeuvre.duration_s() > left_s + 1e-9) {
      continue;
    }
    DriveRecord longer = record;
    longer.add(manoeuvre);
    DriveProgress progress = goal.progress(longer.windows());
    const double gain = (now.missing - progress.missing) / manoeuvre.duration_s();
    if (std::isfinite(gain) && gain > best.gain && possible.allows(manoeuvre)) {
      best = {gain, std::move(manoeuvre), std::move(progress)};
    }
  }
  return best;
}

}  // namespace

void DriveExtent::include(const DriveMotion& motion) {
  farthest_m = std::max(farthest_m, std::hypot(motion.position_m[0], motion.position_m[1]));
  fastest_m_s = std::max(fastest_m_s, std::hypot(std::hypot(motion.velocity[0], motion.velocity[1]),
                                                 motion.velocity[2]));
  depth_m = std::max(depth_m, std::abs(motion.position_m[2]));
  tilt_rad = std::max({tilt_rad, std::abs(motion.angles_rad[0]), std::abs(motion.angles_rad[1])});
}

bool DriveExtent::within(const DriveBounds& bounds) const {
  return farthest_m <= bounds.radius_m && fastest_m_s <= bounds.speed_m_s &&
         depth_m <= bounds.depth_m && tilt_rad <= bounds.tilt_rad;
}

PossibleVehicles::PossibleVehicles(const DrivableVehicle& vehicle, const DriveBounds& bounds,
                                   const DriveMotion& start)
    : bounds_(bounds), motions_(1 + kTuning.plan.draws, start) {
  bounds_.depth_m *= kTuning.plan.narrower;
  bounds_.tilt_rad *= kTuning.plan.narrower;
  const ParameterFit& fit = vehicle.expected().now();
  vehicles_.push_back(vehicle.vehicle_of(fit));
  const Eigen::MatrixXd root = root_of_errors(fit);
  RandomStream random(1, "possible vehicles");
  while (vehicles_.size() < motions_.size()) {
    vehicles_.push_back(vehicle.vehicle_of(drawn_fit(fit, root, random)));
  }
}

bool PossibleVehicles::advance(const Manoeuvre& manoeuvre, std::vector<DriveMotion>& motions,
                               DriveExtent& extent) const {
  const auto keeps = [&](std::size_t i, DriveMotion& motion, const HeldSpeeds& part) {
    const auto steps =
        static_cast<int>(std::lround(kTuning.plan.substeps * part.duration_s / kManoeuvreStepS));
    for (int step = 0; step < steps; ++step) {
      vehicles_[i](part.speeds, kManoeuvreStepS / kTuning.plan.substeps, motion);
      extent.include(motion);
      if (!extent.within(bounds_) ||
          !(std::abs(motion.velocity[5]) < kFullTurn * kTuning.plan.most_turns_per_s)) {
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
    DriveMotion coasting = motions[i];
    const std::vector<double> off(manoeuvre.parts.front().speeds.size(), 0.0);
    if (!keeps(i, coasting, {kTuning.plan.coast_s, off})) {
      return false;
    }
  }
  return true;
}

bool PossibleVehicles::allows(const Manoeuvre& manoeuvre) const {
  std::vector<DriveMotion> motions = motions_;
  DriveExtent extent;
  return advance(manoeuvre, motions, extent);
}

bool PossibleVehicles::drive(const Manoeuvre& manoeuvre) {
  std::vector<DriveMotion> motions = motions_;
  DriveExtent extent = extent_;
  if (!advance(manoeuvre, motions, extent)) {
    return false;
  }
  motions_ = std::move(motions);
  extent_ = extent;
  return true;
}

double DrivePlan::duration_s() const {
  double sum = 0.0;
  for (const Manoeuvre& manoeuvre : manoeuvres) {
    sum += manoeuvre.duration_s();
  }
  return sum;
}

std::vector<std::size_t> wanted_places(const ParameterFit& fit,
                                       const std::vector<std::string>& names) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    if (fit.parameters[i].state != ParameterState::known &&
        (!names.empty() || is_usual(fit.parameters[i])) &&
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
    if (std::ranges::none_of(known, [&](const std::string& of) { return has_words(of, name); })) {
      throw InputError("--tell", unknown_name(name, "parameter", known));
    }
  }
  return places;
}

double interval_share(const ParameterFit& fit, std::size_t place) {
  const FittedParameter& parameter = fit.parameters[place];
  return kNormal90 * parameter.error / std::max(size_of(fit, parameter), 1e-12);
}

DriveGoal telling_goal(const ExpectedFit& expected, std::vector<std::size_t> parameters,
                       double share, FitScale scale) {
  ParameterFit scaled = expected.now();
  scale(scaled);
  std::erase_if(parameters, [&](std::size_t place) {
    const ParameterState state = scaled.parameters[place].state;
    return state == ParameterState::known || state == ParameterState::at_bound;
  });
  require(!parameters.empty(), "--tell", "names no parameter that a drive can tell");
  DriveGoal goal;
  for (const std::size_t place : parameters) {
    goal.names.push_back(expected.now().parameters[place].name);
  }
  goal.progress = [&expected, parameters = std::move(parameters), share,
                   scale = std::move(scale)](const WeakRows& windows) {
    ParameterFit fit = expected.after(windows);
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

DriveGoal parting_goal(const ExpectedFit& expected, const std::string& first,
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

DrivePlan plan_drive(const DrivableVehicle& vehicle, const DriveBounds& bounds,
                     const DriveGoal& goal, const DriveMotion& start) {
  Candidates candidates(vehicle.push());
  PossibleVehicles possible(vehicle, bounds, start);
  DriveRecord record(vehicle, start);
  DrivePlan plan{.names = goal.names};
  DriveProgress now = goal.progress(WeakRows{});
  plan.countdown.push_back({0.0, "", now.numbers});
  double t_s = 0.0;
  while (!now.reached) {
    DriveChoice best =
        best_of(candidates.next(possible), record, possible, goal, now, bounds.time_s - t_s);
    if (best.gain <= 0.0) {
      break;
    }
    now = std::move(best.progress);
    possible.drive(best.manoeuvre);
    record.add(best.manoeuvre);
    t_s += best.manoeuvre.duration_s();
    plan.countdown.push_back({t_s, best.manoeuvre.name, now.numbers});
    plan.manoeuvres.push_back(std::move(best.manoeuvre));
  }
  plan.reached = now.reached;
  const double misfit = vehicle.expected().now().misfit;
  require(plan.reached || !plan.manoeuvres.empty(), "bounds",
          misfit > kWrongVehicle
              ? fmt::format("leave room for no manoeuvre of the vehicle found in the log, which is "
                            "probably wrong (misfit {:.0f}; 1: chance): kelpie identify tells more",
                            misfit)
              : "leave room for no manoeuvre: give more time, speed or space");
  plan.track = record.track();
  plan.extent = possible.extent();
  return plan;
}

}  // namespace kelpie::study
