// SPDX-License-Identifier: Apache-2.0
#include "log/body_frame.hpp"

#include <algorithm>
#include <array>

#include "kelpie/core/error.hpp"

namespace kelpie::log {
namespace {

Signal& signal_of(std::vector<Signal>& signals, const std::string& name) {
  return *std::ranges::find(signals, name, &Signal::name);
}

// The three signals of a vector, sample by sample.
class VectorSignal {
 public:
  VectorSignal(std::vector<Signal>& signals, const std::array<std::string, 3>& names)
      : parts_{&signal_of(signals, names[0]), &signal_of(signals, names[1]),
               &signal_of(signals, names[2])} {
    for (const Signal* const part : parts_) {
      if (part->times_s != parts_[0]->times_s) {
        throw InputError(part->from, "doesn't come in the same messages as " + parts_[0]->from +
                                         "; the three components of a vector have to");
      }
    }
  }

  const std::vector<double>& times_s() const { return parts_[0]->times_s; }

  template <typename Change>
  void change(Change change) {
    for (std::size_t k = 0; k < times_s().size(); ++k) {
      const Triple changed =
          change(Triple{parts_[0]->values[k], parts_[1]->values[k], parts_[2]->values[k]}, k);
      for (std::size_t c = 0; c < changed.size(); ++c) {
        parts_[c]->values[k] = changed[c];
      }
    }
  }

 private:
  std::array<Signal*, 3> parts_;
};

void take_out(const SamplingPlan::LeverArm& lever, std::vector<Signal>& signals, double gap_s) {
  VectorSignal velocity(signals, lever.velocity);
  std::array<std::vector<double>, 3> rates;
  for (std::size_t c = 0; c < rates.size(); ++c) {
    Signal rate = signal_of(signals, lever.rates[c]);
    tidy(rate, gap_s);
    rates[c] = resampled(rate, velocity.times_s(), Between::line, gap_s);
  }
  velocity.change([&](const Triple& v, std::size_t k) {
    return without_lever_arm(v, {rates[0][k], rates[1][k], rates[2][k]}, lever.arm_m);
  });
}

}  // namespace

void to_body_frame(const SamplingPlan& plan, std::vector<Signal>& signals) {
  std::ranges::for_each(signals, sort_by_time);
  for (const SamplingPlan::Vector& vector : plan.vectors) {
    VectorSignal(signals, vector.columns).change([&](const Triple& value, std::size_t) {
      return converted(value, vector.from, vector.to);
    });
  }
  if (plan.lever_arm) {
    take_out(*plan.lever_arm, signals, plan.gap_s);
  }
}

}  // namespace kelpie::log
