// SPDX-License-Identifier: Apache-2.0
#include "kelpie/stream/stream_plan.hpp"

#include <algorithm>
#include <span>

#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/setting.hpp"
#include "stream/tuning.hpp"

namespace kelpie {
namespace {

[[noreturn]] void refuse(const std::string& name, const std::string& message) {
  throw InputError(name, message);
}

class NameCheck {
 public:
  explicit NameCheck(const StreamPlan& plan) {
    for (const StreamPlan::Source& source : plan.sources) {
      add(source.name);
    }
    sources_ = names_;
    for (const StreamPlan::Derived& derived : plan.derived) {
      add(derived.name);
    }
    if (plan.pose) {
      std::ranges::for_each(plan.pose->columns(), [&](const auto& name) { add(name); });
    }
  }

  void require_sources(const std::string& user, std::span<const std::string> names) const {
    require_known(user, names, sources_, "state or command");
  }
  void require_columns(const std::string& user, std::span<const std::string> names) const {
    require_known(user, names, names_, "state, command or derivative");
  }

 private:
  static void require_known(const std::string& user, std::span<const std::string> names,
                            const std::vector<std::string>& known, const char* kind) {
    std::ranges::for_each(names, [&](const auto& name) { require_name(user, name, kind, known); });
  }

  void add(const std::string& name) {
    if (name == "t" || std::ranges::find(names_, name) != names_.end()) {
      refuse(name, name == "t" ? "is the name of the time; take another"
                               : "is the name of two columns; each needs its own");
    }
    names_.push_back(name);
  }

  std::vector<std::string> names_;
  std::vector<std::string> sources_;
};

void validate_frames(const StreamPlan::Vector& vector, const NameCheck& names) {
  if (vector.attitude.empty()) {
    converted(Triple{}, vector.from, vector.to);  // has the check
    return;
  }
  const auto is_of_world = [](Frame frame) { return frame == Frame::ned || frame == Frame::enu; };
  names.require_sources("vectors", vector.attitude);
  if (!is_of_world(vector.from) || is_of_world(vector.to)) {
    refuse("vectors", "an attitude turns from NED or ENU to FRD or FLU");
  }
  if (vector.attitude.size() != 3 && vector.attitude.size() != 4) {
    refuse("vectors",
           "an attitude is three angles, roll, pitch and yaw, or a quaternion w, x, y, z");
  }
  for (const std::string& name : vector.attitude) {
    if (std::ranges::find(vector.columns, name) != vector.columns.end()) {
      refuse("vectors", "'" + name + "' is turned itself; it is no attitude");
    }
  }
}

void validate_pose(const StreamPlan& plan, const NameCheck& names) {
  const StreamPlan::Pose& pose = *plan.pose;
  const std::size_t angles = pose.attitude.size();
  names.require_sources("pose", pose.sources());
  if (angles != 0 && angles != 3 && angles != 4) {
    refuse("pose", "its attitude is roll, pitch and yaw, or a quaternion w, x, y, z");
  }
  if (angles == 4 && std::ranges::count(pose.attitude, "") > 0) {
    refuse("pose", "a quaternion has four parts, w, x, y, z");
  }
  const bool has_x = !pose.position[0].empty();
  const bool has_yaw = angles == 4 || (angles == 3 && !pose.attitude[2].empty());
  if (has_x != !pose.position[1].empty()) {
    refuse("pose", "x and y belong together; one of them alone gives no velocity of the body");
  }
  if (has_x && !has_yaw) {
    refuse("pose",
           "x and y turn into velocities of the body by a yaw (or a quaternion), which is "
           "missing");
  }
  if (pose.axes().empty()) {
    refuse("pose", "measures no motion; name x, y and yaw, or z (depth), or yaw alone");
  }
  require_range("window", 2.0 * pose.half_s, {.low = 0.0, .high = stream::kTuning.longest_window_s},
                "s");
  if (!plan.derived.empty()) {
    refuse(plan.derived.front().name,
           "is a derivative beside a pose, which gives accelerations itself; leave it out");
  }
}

}  // namespace

std::vector<std::size_t> StreamPlan::Pose::axes() const {
  const bool is_quaternion = attitude.size() == 4;
  const auto is_there = [&](std::size_t angle) {
    return is_quaternion || (attitude.size() == 3 && !attitude[angle].empty());
  };
  std::vector<std::size_t> measured;
  for (std::size_t axis = 0; axis < kVelocities.size(); ++axis) {
    const bool is_tilt = axis == 3 || axis == 4;
    if (axis < 3 ? !position[axis].empty() : is_there(axis - 3) && (!is_tilt || has_tilt_rates)) {
      measured.push_back(axis);
    }
  }
  return measured;
}

std::vector<std::string> StreamPlan::Pose::columns() const {
  std::vector<std::string> names;
  for (const std::size_t axis : axes()) {
    names.emplace_back(kVelocities[axis]);
  }
  if (attitude.size() == 4) {
    names.insert(names.end(), {"phi", "theta", "psi"});
  }
  const std::vector<std::string> slopes = accelerations();
  names.insert(names.end(), slopes.begin(), slopes.end());
  return names;
}

std::vector<std::string> StreamPlan::Pose::accelerations() const {
  std::vector<std::string> names;
  for (const std::size_t axis : axes()) {
    names.push_back(std::string(kVelocities[axis]) + "dot");
  }
  return names;
}

std::vector<std::string> StreamPlan::Pose::sources() const {
  std::vector<std::string> names(position.begin(), position.end());
  names.insert(names.end(), attitude.begin(), attitude.end());
  std::erase(names, "");
  return names;
}

std::size_t StreamPlan::source(const std::string& name) const {
  NameCheck(*this).require_sources(name, std::span(&name, 1));
  return static_cast<std::size_t>(std::ranges::find(sources, name, &Source::name) -
                                  sources.begin());
}

void StreamPlan::validate() const {
  const auto& most = stream::kTuning;
  require_range("rate", rate_hz, {.low = 0.0, .high = most.fastest_hz, .open = true},
                "rows per second");
  require_range("gap", gap_s, {.low = 0.0, .high = most.longest_gap_s, .open = true}, "s");
  require_range("wait", wait_s, {.low = 0.0, .high = most.longest_wait_s}, "s");
  for (const Source& one : sources) {
    require_range("lag." + one.name, one.lag_s.value_or(0.0),
                  {.low = -most.longest_lag_s, .high = most.longest_lag_s}, "s");
  }
  derivative.validate();
  const NameCheck names(*this);
  for (const Derived& one : derived) {
    names.require_sources(one.name, std::span(&one.of, 1));
  }
  for (const Vector& vector : vectors) {
    names.require_sources("vectors", vector.columns);
    validate_frames(vector, names);
  }
  if (lever_arm) {
    names.require_sources("lever_arm", lever_arm->velocity);
    names.require_sources("lever_arm", lever_arm->rates);
  }
  if (pose) {
    validate_pose(*this, names);
  }
  names.require_columns("inputs", inputs);
  names.require_columns("targets", targets);
}

}  // namespace kelpie
