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

void require_range(const std::string& name, double value, const Range& range,
                   const std::string& unit) {
  if (!range.holds(value)) {
    refuse(name,
           number_text(value) + " is out of range; it has to be " + range.text() + " " + unit);
  }
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
  }

  void require_sources(const std::string& user, std::span<const std::string> names) const {
    require_known(user, names, sources_, "states and commands");
  }
  void require_columns(const std::string& user, std::span<const std::string> names) const {
    require_known(user, names, names_, "states, commands and derivatives");
  }

 private:
  static void require_known(const std::string& user, std::span<const std::string> names,
                            const std::vector<std::string>& known, const std::string& kinds) {
    for (const std::string& name : names) {
      if (std::ranges::find(known, name) == known.end()) {
        refuse(user, "'" + name + "' is none of the " + kinds + did_you_mean(name, known) + ": " +
                         join_text(known, ", "));
      }
    }
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

}  // namespace

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
  names.require_columns("inputs", inputs);
  names.require_columns("targets", targets);
}

}  // namespace kelpie
