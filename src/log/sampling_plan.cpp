// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <span>

#include "kelpie/core/error.hpp"
#include "kelpie/core/setting.hpp"
#include "kelpie/core/text.hpp"
#include "log/sampling.hpp"

namespace kelpie::log {
namespace {

[[noreturn]] void refuse(const std::string& name, const std::string& message) {
  throw InputError(name, message);
}

void require_positive(const std::string& name, double value, const std::string& unit) {
  if (!std::isfinite(value) || value <= 0.0) {
    refuse(name, number_text(value) + " is out of range; it has to be > 0 " + unit);
  }
}

class NameCheck {
 public:
  explicit NameCheck(const SamplingPlan& plan) {
    for (const SamplingPlan::Source& source : plan.sources) {
      add(source.name);
    }
    sources_ = names_;
    for (const SamplingPlan::Derived& derived : plan.derived) {
      add(derived.name);
    }
  }

  void require_sources(const std::string& user, std::span<const std::string> names) const {
    for (const std::string& name : names) {
      if (std::ranges::find(sources_, name) == sources_.end()) {
        refuse(user, "'" + name + "' is none of the states and commands" +
                         did_you_mean(name, sources_) + ": " + join_text(sources_, ", "));
      }
    }
  }

 private:
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

}  // namespace

void SamplingPlan::validate() const {
  require_positive("rate", rate_hz, "rows per second");
  require_positive("gap", gap_s, "s");
  derivative.validate();
  const NameCheck names(*this);
  for (const Derived& one : derived) {
    names.require_sources(one.name, std::span(&one.of, 1));
  }
  for (const Vector& vector : vectors) {
    names.require_sources("vectors", vector.columns);
    converted(Triple{}, vector.from, vector.to);  // has the check
  }
  if (lever_arm) {
    names.require_sources("lever_arm", lever_arm->velocity);
    names.require_sources("lever_arm", lever_arm->rates);
  }
}

}  // namespace kelpie::log
