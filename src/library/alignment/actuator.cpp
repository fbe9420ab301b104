// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "kelpie/alignment/alignment.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie {
namespace {

constexpr double kMostKept = 1e6;  // commands on their way through a delay

std::size_t kept_commands(const Actuator& actuator, double rate_hz) {
  constexpr double kFaster = 2.0;  // messages come at other times than usual
  return 4 + static_cast<std::size_t>(
                 std::min(std::ceil(kFaster * actuator.delay_s * rate_hz), kMostKept));
}

}  // namespace

std::span<const Actuator::Field> Actuator::fields() {
  static constexpr std::array<Field, 6> kFields{{{"neutral", &Actuator::neutral},
                                                 {"dead_band", &Actuator::dead_band},
                                                 {"astern", &Actuator::astern},
                                                 {"lag_s", &Actuator::lag_s},
                                                 {"rate", &Actuator::rate},
                                                 {"delay_s", &Actuator::delay_s}}};
  return kFields;
}

void Actuator::validate() const {
  for (const Field& field : fields()) {
    require(std::isfinite(this->*field.number), field.name, "has to be finite");
  }
  require(dead_band >= 0.0, "dead_band", "has to be 0 or more");
  require(astern > 0.0, "astern", "has to be > 0");
  require(lag_s >= 0.0, "lag_s", "has to be 0 s or more");
  require(rate >= 0.0, "rate", "has to be 0 or more");
  require(delay_s >= 0.0 && delay_s <= Alignment::kMostS, "delay_s", "has to be from 0 to 10 s");
}

double Actuator::shaped(double command) const {
  const double off = command - neutral;
  const double effect = std::copysign(std::max(std::abs(off) - dead_band, 0.0), off);
  return effect < 0.0 ? astern * effect : effect;
}

double Actuator::command_for(double effect) const {
  if (effect == 0.0) {
    return neutral;
  }
  const double off = effect < 0.0 ? effect / astern : effect;
  return neutral + off + std::copysign(dead_band, off);
}

ActuatorState::ActuatorState(const Actuator& actuator, double rate_hz) : actuator_(actuator) {
  require(rate_hz > 0.0, "rate", "has to be > 0 rows per second");
  actuator.validate();
  ring_.resize(kept_commands(actuator, rate_hz));
}

const ActuatorState::Given& ActuatorState::kept(std::size_t before_newest) const {
  return ring_[(count_ - 1 - before_newest) % ring_.size()];
}

// Straight lines between the commands; the oldest command kept before all of them.
double ActuatorState::effect_at(double t) const {
  const std::size_t most = std::min(count_, ring_.size());
  std::size_t back = 0;
  while (back + 1 < most && kept(back).t > t) {
    ++back;
  }
  const Given& before = kept(back);
  if (back == 0 || before.t >= t) {
    return before.effect;
  }
  const Given& after = kept(back - 1);
  return before.effect + (after.effect - before.effect) * (t - before.t) / (after.t - before.t);
}

double ActuatorState::next(double command, double t) {
  const double effect = actuator_.shaped(command);
  if (!actuator_.takes_time()) {
    return effect;
  }
  const double step_s = count_ > 0 ? t - kept(0).t : 0.0;
  ring_[count_ % ring_.size()] = {t, effect};
  ++count_;
  if (count_ == 1) {
    value_ = effect;
    return value_;
  }
  const double wanted = effect_at(t - actuator_.delay_s - 0.5 * step_s) - value_;
  const double step =
      actuator_.lag_s > 0.0 ? -std::expm1(-step_s / actuator_.lag_s) * wanted : wanted;
  const double most = actuator_.rate * step_s;
  value_ += actuator_.rate > 0.0 ? std::clamp(step, -most, most) : step;
  return value_;
}

}  // namespace kelpie
