// SPDX-License-Identifier: Apache-2.0
// Garbage at random, at the model's door: bursts of any size up to 30 s, at the start or later, in
// targets, inputs or both, of any number of axes, at 5 and 20 rows per second.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

#include "kelpie/core/random.hpp"
#include "kelpie/model/dynamics_model.hpp"

namespace kelpie::garbage_test {
namespace {

constexpr std::size_t kAxes = 3;
constexpr std::array<double, kAxes> kInputSize{0.3, 560.0, 0.2};
constexpr std::array<double, kAxes> kTargetSize{0.45, 3.0, 0.005};
constexpr std::array<double, kAxes> kTargetMiddle{0.0, 50.0, 0.0};

using Vector = std::array<double, kAxes>;

/// A drive of three inputs of very different units, with noise on speed and targets.
struct Drive {
  std::vector<Vector> x;
  std::vector<Vector> y;
  std::vector<Vector> truth;  ///< targets without noise
};

Vector law(const Vector& x) {
  const auto& [speed, thrust, rudder] = x;
  return {1e-3 * (thrust * std::abs(thrust) / 800.0 - 900.0 * speed * std::abs(speed)),
          50.0 + 5.0 * std::sin(4.0 * speed), 0.02 * (rudder + 0.5 * speed * rudder)};
}

Drive drive(RandomStream& random, std::size_t samples, double step_s) {
  Drive drive;
  Vector phase{1.0, 0.0, 0.5};
  for (std::size_t i = 0; i < samples; ++i) {
    phase[0] += 5.0 * step_s * random.uniform(0.01, 0.05);
    phase[1] += 5.0 * step_s * random.uniform(0.02, 0.1);
    phase[2] += 5.0 * step_s * random.uniform(0.01, 0.08);
    const Vector x{0.1 + 0.4 * std::sin(phase[0]), 800.0 * std::sin(phase[1]),
                   0.3 * std::sin(phase[2])};
    const Vector y = law(x);
    drive.truth.push_back(y);
    drive.x.push_back({x[0] + 0.003 * random.normal(), x[1], x[2]});
    drive.y.push_back({y[0] + 0.03 * random.normal(), y[1] + 0.1 * random.normal(),
                       y[2] + 3e-4 * random.normal()});
  }
  return drive;
}

/// What a sensor says while it is out of order, in usual sizes of the drive.
enum class Shape : std::uint8_t { noise, stuck, signs };

struct Burst {
  std::uint64_t seed;
  double step_s;
  double from_s;
  double lasts_s;
  double size;
  std::array<bool, kAxes> inputs;
  std::array<bool, kAxes> targets;
  Shape shape;

  std::size_t from() const { return static_cast<std::size_t>(from_s / step_s); }
  std::size_t end() const { return static_cast<std::size_t>((from_s + lasts_s) / step_s); }
};

std::ostream& operator<<(std::ostream& out, const Burst& burst) {
  out << "seed " << burst.seed << ", " << burst.lasts_s << " s from " << burst.from_s
      << " s, every " << burst.step_s << " s, size " << burst.size << ", shape "
      << static_cast<int>(burst.shape);
  for (std::size_t k = 0; k < kAxes; ++k) {
    out << (burst.inputs[k] ? ", input " : "") << (burst.inputs[k] ? std::to_string(k) : "")
        << (burst.targets[k] ? ", target " : "") << (burst.targets[k] ? std::to_string(k) : "");
  }
  return out;
}

// Where no column is drawn, all targets are garbage.
Burst random_burst(std::uint64_t seed, bool first) {
  RandomStream random(seed, "burst");
  Burst burst{.seed = seed,
              .step_s = seed % 2 == 0 ? 0.2 : 0.05,
              .from_s = first ? 0.0 : random.uniform(100.0, 240.0),
              .lasts_s = random.uniform(0.4, 30.0),
              .size = std::pow(10.0, random.uniform(3.0, 12.0)),
              .inputs = {},
              .targets = {},
              .shape = static_cast<Shape>(random.below(3))};
  for (std::size_t k = 0; k < kAxes; ++k) {
    burst.inputs[k] = random.uniform() < 0.4;
    burst.targets[k] = random.uniform() < 0.4;
  }
  const bool none = std::ranges::none_of(burst.inputs, std::identity{}) &&
                    std::ranges::none_of(burst.targets, std::identity{});
  std::ranges::for_each(burst.targets, [none](bool& target) { target = target || none; });
  return burst;
}

void put(const Burst& burst, Drive& drive) {
  RandomStream random(burst.seed, "garbage");
  Vector stuck{};
  std::ranges::generate(stuck, [&] { return random.uniform() < 0.5 ? -1.0 : 1.0; });
  const auto value = [&](std::size_t k) {
    const double sign = random.uniform() < 0.5 ? -1.0 : 1.0;
    return burst.size * (burst.shape == Shape::noise   ? random.normal()
                         : burst.shape == Shape::stuck ? stuck[k]
                                                       : sign);
  };
  for (std::size_t i = burst.from(); i < burst.end(); ++i) {
    for (std::size_t k = 0; k < kAxes; ++k) {
      if (burst.inputs[k]) {
        drive.x[i][k] = kInputSize[k] * value(k);
      }
      if (burst.targets[k]) {
        drive.y[i][k] = kTargetMiddle[k] + kTargetSize[k] * value(k);
      }
    }
  }
}

DynamicsModel new_model() {
  return {{"speed", "thrust", "rudder"},
          {"surge", "sway", "yaw"},
          ModelSettings::from_preset("default", kAxes)};
}

Vector r_squared(const DynamicsModel& model, const Drive& drive, std::size_t from) {
  Vector mean{};
  Vector wrong{};
  Vector spread{};
  Vector said{};
  for (std::size_t k = 0; k < kAxes; ++k) {
    for (std::size_t i = from; i < drive.truth.size(); ++i) {
      mean[k] += drive.truth[i][k] / static_cast<double>(drive.truth.size() - from);
    }
  }
  for (std::size_t i = from; i < drive.truth.size(); ++i) {
    model.predict(drive.x[i], said);
    for (std::size_t k = 0; k < kAxes; ++k) {
      wrong[k] += std::pow(drive.truth[i][k] - said[k], 2);
      spread[k] += std::pow(drive.truth[i][k] - mean[k], 2);
    }
  }
  Vector r2{};
  for (std::size_t k = 0; k < kAxes; ++k) {
    r2[k] = 1.0 - wrong[k] / spread[k];
  }
  return r2;
}

/// The range of targets so far, with a margin, as SeenRange allows.
class Seen {
 public:
  bool holds(const Vector& said) const {
    for (std::size_t k = 0; k < kAxes; ++k) {
      const double margin = 0.11 * (most_[k] - least_[k]);
      if (!(said[k] >= least_[k] - margin) || said[k] > most_[k] + margin) {
        return false;
      }
    }
    return true;
  }
  void see(const Vector& y) {
    for (std::size_t k = 0; k < kAxes; ++k) {
      least_[k] = std::min(least_[k], y[k]);
      most_[k] = std::max(most_[k], y[k]);
    }
  }

 private:
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  Vector least_{kNone, kNone, kNone};
  Vector most_{-kNone, -kNone, -kNone};
};

struct Outcome {
  Vector with{};     ///< R² of each axis
  Vector without{};  ///< of a model that never had the rows of the burst
};

// A minute after the burst. Until then, nothing may be said beyond what was seen.
Outcome outcome_of(const Burst& burst) {
  RandomStream random(burst.seed, "drive");
  const auto later = [&](double seconds) {
    return burst.end() + static_cast<std::size_t>(seconds / burst.step_s);
  };
  const std::size_t judged = later(60.0);
  Drive received = drive(random, later(160.0), burst.step_s);
  const Drive clean = received;
  put(burst, received);
  DynamicsModel with = new_model();
  DynamicsModel without = new_model();
  Seen seen;
  Vector said{};
  constexpr std::size_t kFew = 100;  // rows tell little about the range
  for (std::size_t i = 0; i < judged; ++i) {
    const double t = burst.step_s * static_cast<double>(i);
    with.predict(received.x[i], said);
    EXPECT_TRUE(i < kFew || seen.holds(said)) << "row " << i;
    with.update(received.x[i], received.y[i], t);
    seen.see(received.y[i]);
    if (i < burst.from() || i >= burst.end()) {
      without.update(clean.x[i], clean.y[i], t);
    }
  }
  return {r_squared(with, clean, judged), r_squared(without, clean, judged)};
}

class RandomGarbage : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(RandomGarbage, InTargetsIsHarmlessAMinuteAfter) {
  Burst burst = random_burst(GetParam(), false);
  burst.targets[GetParam() % kAxes] = true;
  burst.inputs = {};
  SCOPED_TRACE(burst);
  const Outcome outcome = outcome_of(burst);
  for (std::size_t k = 0; k < kAxes; ++k) {
    EXPECT_GT(outcome.with[k], outcome.without[k] - 0.01) << "axis " << k;
  }
}

// Garbage in inputs, or at the start, may cost an axis more (docs/measured/accuracy.md).
TEST_P(RandomGarbage, AnywhereSaysNothingBeyondWhatWasSeen) {
  const Burst burst = random_burst(GetParam() + 100, GetParam() % 3 == 0);
  SCOPED_TRACE(burst);
  outcome_of(burst);
}

INSTANTIATE_TEST_SUITE_P(Seed, RandomGarbage, ::testing::Values(1));
INSTANTIATE_TEST_SUITE_P(Measured, RandomGarbage, ::testing::Range<std::uint64_t>(2, 6));

}  // namespace
}  // namespace kelpie::garbage_test
