// SPDX-License-Identifier: Apache-2.0
#include "kelpie/navigation/dead_reckoning.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "core/angle.hpp"
#include "kelpie/core/error.hpp"
#include "navigation/named_settings.hpp"
#include "navigation/practice.hpp"
#include "navigation/tuning.hpp"
#include "navigation/velocity_check.hpp"
#include "navigation/velocity_filter.hpp"

namespace kelpie {
namespace {

constexpr const auto& kChoice = kNavigationTuning.choice;
constexpr const char* kPlanarNeeds = "needs surge, sway and yaw rate as the first three velocities";

using Index = Eigen::Index;

// Numbers of the states whose velocities are measured.
struct Measured {
  std::array<Index, VelocityFilter::kMostVelocities> which{};
  std::size_t count = 0;

  std::span<const Index> all() const { return std::span(which).first(count); }
};

using Velocities = std::array<double, VelocityFilter::kMostVelocities>;

struct Estimate {
  Velocities velocity{};
  Velocities deviation{};
};

}  // namespace

struct DeadReckoning::State {
  /// One belief about the water, its filter and what it learned in practice.
  struct Hypothesis {
    VelocityFilter filter;
    Practice practice;

    Hypothesis(const OpenLoop& model, const DeadReckoningSettings& settings, double current_m_s,
               double wander)
        : filter(model, with(settings, current_m_s, wander)),
          practice(filter, settings.practice_s) {}

    void use(const OpenLoop& model) {
      filter.use(model);
      practice.use(model);
    }

    static DeadReckoningSettings with(DeadReckoningSettings settings, double current_m_s,
                                      double wander) {
      settings.current_m_s = current_m_s;
      settings.current_wander = wander;
      return settings;
    }
  };

  /// Without a current, with a constant, a wandering current; a wandering current and a kept model.
  std::vector<Hypothesis> hypotheses;
  bool keeps_model = false;  ///< the last hypothesis, until a later model is clearly better
  std::size_t believed = 0;
  DeadReckoningSettings settings;
  VelocityCheck check;
  VelocityCheck::Faults faults{};  ///< of the last sample
  std::vector<double> sample;      ///< the last sample; NaN: no velocity was measured
  bool started = false;
  double time_s = 0.0;
  double apart_share = 0.0;  ///< of late, samples that no hypothesis joins to the one before
  double heard_s = 0.0;      ///< when a velocity other than the yaw rate was measured last
  double step = 0.0;
  Velocities first{};    ///< before the start: the last value of each velocity
  Velocities first_s{};  ///< and its time
  bool has_heading = false;
  double first_heading = 0.0;  ///< before the start: the last measured heading
  double first_heading_variance = 0.0;

  State(const OpenLoop& model, const DeadReckoningSettings& given)
      : settings(given), sample(model.seen.size()) {
    first_s.fill(-std::numeric_limits<double>::infinity());
    const bool current = given.planar && given.current_m_s > 0.0;
    const bool choice = given.practice_s > 0.0;
    if (!current || choice) {
      hypotheses.emplace_back(model, given, 0.0, 0.0);
    }
    if (current && (choice || given.current_wander == 0.0)) {
      hypotheses.emplace_back(model, given, given.current_m_s, 0.0);
    }
    if (current && given.current_wander > 0.0) {
      hypotheses.emplace_back(model, given, given.current_m_s, given.current_wander);
    }
    if (current && choice) {
      hypotheses.push_back(hypotheses.back());
      keeps_model = true;
    }
  }

  const VelocityFilter& filter() const { return hypotheses[believed].filter; }
  std::size_t states() const { return static_cast<std::size_t>(filter().velocities()); }
  double silent_s() const { return time_s - heard_s; }
  double deviation(Index i) const {
    return widening() * std::sqrt(std::max(filter().covariance()(i, i), 0.0));
  }
  double widening() const { return widening(hypotheses[believed].practice); }
  double widening(const Practice& practice) const {
    const double age_s = silent_s();
    return age_s > 0.0 ? std::max(practice.velocity_widening(age_s), kChoice.least_widening) : 1.0;
  }

  Measured measured_in(std::span<const double> x) const {
    Measured measured;
    for (Index i = 0; i < filter().velocities(); ++i) {
      if (std::isfinite(x[filter().model().states[static_cast<std::size_t>(i)]])) {
        measured.which[measured.count++] = i;
      }
    }
    return measured;
  }

  // Of the measured velocities, in their order.
  VelocityFilter::Matrix noise_of(const Measured& measured,
                                  std::span<const double> covariance) const {
    const auto count = static_cast<Index>(measured.count);
    const auto all = static_cast<std::size_t>(filter().velocities());
    const std::vector<double>& usual = filter().model().noise;
    VelocityFilter::Matrix noise = VelocityFilter::Matrix::Zero(count, count);
    for (Index i = 0; i < count; ++i) {
      const auto row = static_cast<std::size_t>(measured.which[static_cast<std::size_t>(i)]);
      if (covariance.empty()) {
        noise(i, i) = std::max(usual[row] * usual[row], kChoice.least_noise);
        continue;
      }
      for (Index j = 0; j < count; ++j) {
        const auto column = static_cast<std::size_t>(measured.which[static_cast<std::size_t>(j)]);
        noise(i, j) = covariance[row * all + column];
      }
    }
    return noise;
  }

  bool is_of_log(Index i) const { return filter().is_of_log(i); }

  Index of_log() const {
    Index count = 0;
    for (Index i = 0; i < filter().velocities(); ++i) {
      count += is_of_log(i) ? 1 : 0;
    }
    return count;
  }

  // Whether more than a gyro is heard.
  bool hears(const Measured& measured) const {
    return std::ranges::any_of(measured.all(), [&](Index i) { return is_of_log(i); });
  }

  // The inputs with NaN in place of what wasn't measured.
  void take(std::span<const double> given, double t) {
    sample.assign(given.begin(), given.end());
    faults = {};
    if (settings.checks && started) {
      faults = check.judge(sample, std::max(t, time_s), hypotheses[believed].filter);
    }
    for (std::size_t i = 0; i < states(); ++i) {
      double& value = sample[filter().model().states[i]];
      if (!std::isfinite(value)) {
        faults[i] = VelocityFault::missing;
      } else if (faults[i] != VelocityFault::none) {
        value = std::numeric_limits<double>::quiet_NaN();
      }
    }
  }

  // Puts the last velocities into the sample; whether all are known and the commands, too.
  bool gather(double t) {
    bool is_whole = true;
    for (std::size_t i = 0; i < states(); ++i) {
      double& value = sample[filter().model().states[i]];
      if (std::isfinite(value)) {
        first[i] = value;
        first_s[i] = t;
      }
      is_whole = is_whole && std::abs(t - first_s[i]) <= kNavigationTuning.check.most_apart_s;
      value = first[i];
    }
    return is_whole &&
           std::ranges::all_of(sample, [](double value) { return std::isfinite(value); });
  }

  // `told`: the velocities of the last sample, of which alone there is a covariance.
  void start(double t, const Measured& told, std::span<const double> covariance) {
    VelocityFilter::Matrix noise = noise_of(measured_in(sample), {});
    const std::span<const Index> which = told.all();
    const VelocityFilter::Matrix given = noise_of(told, covariance);
    for (std::size_t i = 0; i < which.size(); ++i) {
      for (std::size_t k = 0; k < which.size(); ++k) {
        noise(which[i], which[k]) = given(static_cast<Index>(i), static_cast<Index>(k));
      }
    }
    for (Hypothesis& one : hypotheses) {
      one.filter.start(sample, noise);
      if (has_heading) {
        one.filter.take(one.filter.heading(), first_heading, first_heading_variance);
      }
    }
    started = true;
    time_s = heard_s = t;
  }

  void update(double t, const Measured& measured, const VelocityFilter::Matrix& noise) {
    const double dt_s = std::max(t - time_s, 0.0);
    VelocityFilter::Vector values(static_cast<Index>(measured.count));
    for (Index i = 0; i < values.size(); ++i) {
      values(i) = sample[filter().model().states[static_cast<std::size_t>(
          measured.which[static_cast<std::size_t>(i)])]];
    }
    const bool heard = hears(measured);
    const bool complete =
        std::ranges::count_if(measured.all(), [&](Index i) { return is_of_log(i); }) == of_log();
    const bool gyro_alone =
        settings.planar && !heard && measured.count == 1 && measured.which[0] == 2;
    const bool lost = t - heard_s > std::max(kNavigationTuning.check.longest_gap_s, dt_s) && !heard;
    double least_off = std::numeric_limits<double>::infinity();
    for (auto& [one, practice] : hypotheses) {
      one.predict(sample, dt_s, practice.factor());
    }
    time_s = std::max(time_s, t);
    const Estimate before = estimate();
    for (auto& [one, practice] : hypotheses) {
      if (gyro_alone) {
        one.take(2, values(0), noise(0, 0));
      } else if (measured.count > 0) {
        least_off =
            std::min(least_off, one.correct(measured.all(), values, noise, widening(practice)));
      }
    }
    // Nobody's model joins the samples; where that is often so, it is the model.
    const bool apart = complete && least_off > kChoice.cut;
    apart_share += kChoice.apart_memory * ((apart ? 1.0 : 0.0) - apart_share);
    const bool cut = apart && apart_share < kChoice.most_apart;
    for (auto& [one, practice] : hypotheses) {
      practice.follow(one, sample, dt_s, complete && !cut, lost || cut);
      if (heard && one.planar()) {
        one.forget_position();
      }
    }
    note_doubts(measured);
    note_step(before);
    if (heard) {
      heard_s = time_s;
      believe();
    }
  }

  void note_doubts(const Measured& measured) {
    for (const Index i : measured.all()) {
      if (is_of_log(i) && filter().doubtful(i)) {
        faults[static_cast<std::size_t>(i)] = VelocityFault::implausible;
      }
    }
  }

  Estimate estimate() const {
    Estimate now;
    for (Index i = 0; i < filter().velocities(); ++i) {
      now.velocity[static_cast<std::size_t>(i)] = filter().mean()(i);
      now.deviation[static_cast<std::size_t>(i)] = deviation(i);
    }
    return now;
  }

  // Of the velocities of the log: a gyro is taken as measured.
  void note_step(const Estimate& before) {
    step = 0.0;
    for (Index i = 0; i < filter().velocities(); ++i) {
      const auto place = static_cast<std::size_t>(i);
      if (is_of_log(i) && before.deviation[place] > 0.0) {
        step = std::max(
            step, std::abs(filter().mean()(i) - before.velocity[place]) / before.deviation[place]);
      }
    }
  }

  // A model learned in a current takes the current for dynamics, and the filter would count the
  // current twice: beside the later models an earlier model stays, until practice prefers the
  // later.
  void use(const OpenLoop& model) {
    const std::size_t renewed = hypotheses.size() - (keeps_model ? 1 : 0);
    for (Hypothesis& one : std::span(hypotheses).first(renewed)) {
      one.use(model);
    }
    if (keeps_model &&
        is_better(hypotheses[renewed - 1].practice, hypotheses.back().practice, kChoice.better)) {
      hypotheses.back() = hypotheses[renewed - 1];
    }
  }

  static bool is_better(const Practice& one, const Practice& other, double enough) {
    return std::min(one.judged(), other.judged()) >= kChoice.least_scored &&
           one.error() < enough * other.error();
  }

  // Whichever was less off in practice; a richer one has to be a good deal better, since a few
  // outages tell little.
  void believe() {
    for (std::size_t i = 0; i < hypotheses.size(); ++i) {
      const double enough = i > believed ? kChoice.better : 1.0;
      if (is_better(hypotheses[i].practice, hypotheses[believed].practice, enough)) {
        believed = i;
      }
    }
  }
};

std::string_view fault_name(VelocityFault fault) {
  constexpr std::array<std::string_view, kVelocityFaults> kNames{"none", "missing", "repeated",
                                                                 "zero", "frozen",  "implausible"};
  return kNames[static_cast<std::size_t>(fault)];
}

void DeadReckoningSettings::validate(std::size_t states) const {
  require(step_s > 0.0 && std::isfinite(step_s), "step", "has to be > 0 s");
  require(!planar || states >= 3, "planar", kPlanarNeeds);
  require(current_m_s >= 0.0 && std::isfinite(current_m_s), "current", "has to be >= 0 m/s");
  require(current_wander >= 0.0 && std::isfinite(current_wander), "current_wander",
          "has to be >= 0 m/s/√s");
  for (const std::size_t rate : rates) {
    require(rate < states, "rates", "have to be velocities of the model");
  }
  require(practice_s >= 0.0 && std::isfinite(practice_s), "practice", "has to be >= 0 s");
}

DeadReckoning::DeadReckoning(const OpenLoop& model, const DeadReckoningSettings& settings) {
  require(model.states.size() <= VelocityFilter::kMostVelocities, "states",
          "of dead reckoning are at most six");
  settings.validate(model.states.size());
  require(!settings.planar || may_be_planar(model), "planar", kPlanarNeeds);
  DeadReckoningSettings complete = settings;
  if (complete.rates.empty()) {
    complete.rates = named_settings(model).rates;
  }
  state_ = std::make_unique<State>(model, complete);
}

DeadReckoning::~DeadReckoning() = default;
DeadReckoning::DeadReckoning(DeadReckoning&& other) noexcept = default;
DeadReckoning& DeadReckoning::operator=(DeadReckoning&& other) noexcept = default;

DeadReckoning::DeadReckoning(const DeadReckoning& other)
    : state_(std::make_unique<State>(*other.state_)) {}

DeadReckoning& DeadReckoning::operator=(const DeadReckoning& other) {
  return *this = DeadReckoning(other);
}

void DeadReckoning::update(std::span<const double> x, double t,
                           std::span<const double> covariance) {
  State& s = *state_;
  const std::size_t states = s.states();
  require_size("x", x.size(), s.filter().model().seen.size());
  if (!covariance.empty()) {
    require_size("covariance", covariance.size(), states * states);
  }
  require(std::isfinite(t), "t", "has to be finite");
  require(!s.started || t - s.time_s <= Rollout::kMostSteps * s.settings.step_s, "t",
          "has to be at most a million steps of the integrator after the last");
  if (!covariance.empty()) {
    require(s.noise_of(s.measured_in(x), covariance).allFinite(), "covariance", "has to be finite");
  }
  s.take(x, t);
  if (s.started) {
    const Measured measured = s.measured_in(s.sample);
    s.update(t, measured, s.noise_of(measured, covariance));
  } else if (const Measured told = s.measured_in(s.sample); s.gather(t)) {
    s.start(t, told, covariance);
  }
}

void DeadReckoning::use(const OpenLoop& model) {
  const OpenLoop& old = state_->filter().model();
  require_size("seen", model.seen.size(), old.seen.size());
  require(model.states == old.states, "states", "have to be those of the first model");
  state_->use(model);
}

void DeadReckoning::restate(std::span<const double> x, CommandPath between) {
  require_size("x", x.size(), state_->filter().model().seen.size());
  state_->settings.between = between;
  for (auto& [filter, practice] : state_->hypotheses) {
    filter.restate(x, between);
    practice.restate(x, between);
  }
}

void DeadReckoning::measured_heading(double heading, double deviation) {
  require(state_->settings.planar, "heading", "is known of planar motion only");
  require(std::isfinite(heading), "heading", "has to be finite");
  require(deviation > 0.0 && std::isfinite(deviation), "deviation", "has to be > 0 rad");
  const double variance = deviation * deviation;
  const bool is_first = !std::exchange(state_->has_heading, true);
  if (!state_->started) {
    state_->first_heading = heading;
    state_->first_heading_variance = variance;
    return;
  }
  for (auto& [filter, practice] : state_->hypotheses) {
    const double now = filter.mean()(filter.heading());
    const double value = now + wrapped(heading - now);
    if (is_first) {
      // The heading of 0 at the start is a choice of axes, which no measurement contradicts.
      filter.take(filter.heading(), value, variance);
      practice.stop();
    } else {
      filter.correct(std::array<Index, 1>{filter.heading()},
                     VelocityFilter::Vector::Constant(1, value),
                     VelocityFilter::Matrix::Constant(1, 1, variance));
    }
  }
}

std::size_t DeadReckoning::states() const {
  return state_->states();
}

bool DeadReckoning::started() const {
  return state_->started;
}

double DeadReckoning::silent_s() const {
  return state_->silent_s();
}

VelocityFault DeadReckoning::fault(std::size_t state) const {
  return state_->faults[state];
}

double DeadReckoning::step() const {
  return state_->step;
}

double DeadReckoning::velocity(std::size_t state) const {
  return state_->filter().mean()(static_cast<Index>(state));
}

double DeadReckoning::covariance(std::size_t row, std::size_t column) const {
  const double widening = state_->widening();
  return widening * widening *
         state_->filter().covariance()(static_cast<Index>(row), static_cast<Index>(column));
}

double DeadReckoning::deviation(std::size_t state) const {
  return std::sqrt(std::max(covariance(state, state), 0.0));
}

double DeadReckoning::disturbance(std::size_t state) const {
  return state_->filter().mean()(state_->filter().velocities() + static_cast<Index>(state));
}

double DeadReckoning::heading() const {
  const VelocityFilter& filter = state_->filter();
  return filter.planar() ? filter.mean()(filter.heading()) : 0.0;
}

std::array<double, 2> DeadReckoning::current() const {
  const VelocityFilter& filter = state_->filter();
  return filter.planar()
             ? std::array{filter.mean()(filter.current()), filter.mean()(filter.current() + 1)}
             : std::array{0.0, 0.0};
}

Drift DeadReckoning::drift() const {
  const VelocityFilter& filter = state_->filter();
  Drift drift;
  if (filter.planar()) {
    const Index p = filter.position();
    drift.position_m = {filter.mean()(p), filter.mean()(p + 1)};
    const double widening =
        state_->hypotheses[state_->believed].practice.widening(state_->silent_s());
    drift.covariance_m2 = {filter.covariance()(p, p), filter.covariance()(p, p + 1),
                           filter.covariance()(p + 1, p), filter.covariance()(p + 1, p + 1)};
    for (double& entry : drift.covariance_m2) {
      entry *= widening * widening;
    }
  }
  return drift;
}

double DeadReckoning::noise_factor() const {
  return state_->hypotheses[state_->believed].practice.factor();
}

}  // namespace kelpie
