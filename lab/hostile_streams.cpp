// SPDX-License-Identifier: Apache-2.0
#include "lab/hostile_streams.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <span>
#include <utility>

#include "core/angle.hpp"

namespace kelpie::lab {
namespace {

using Signals = Eigen::ArrayXXd;
using Eigen::Array3d;
using Eigen::Index;
using std::numbers::pi;

constexpr Index kSamples = kHostileSamples;
constexpr double kPeriodS = 0.2;
constexpr Index kMinute = 300;       // samples
constexpr Index kGoalEvery = 25;     // samples
constexpr double kMostThrust = 1.5;  // [m/s²]
constexpr double kMostSpeed = 20.0;  // [m/s], [rad/s]

template <typename Draw>
Signals drawn(Index rows, Index columns, Draw draw) {
  Signals values(rows, columns);
  std::ranges::generate(std::span(values.data(), static_cast<std::size_t>(values.size())), draw);
  return values;
}

Signals normals(RandomStream& random, Index rows, Index columns) {
  return drawn(rows, columns, [&] { return random.normal(); });
}

Eigen::ArrayXd deviations(const Signals& signals) {
  return (signals.colwise() - signals.rowwise().mean()).square().rowwise().mean().sqrt();
}

// White noise of the size of a signal.
Signals noise(RandomStream& random, const Signals& signal, double size) {
  return normals(random, signal.rows(), signal.cols()).colwise() * (size * deviations(signal));
}

// A ratio of two normal variables has Cauchy's distribution.
Signals cauchy_noise(RandomStream& random, const Signals& signal, double size) {
  const Signals over = noise(random, signal, size);
  return over / normals(random, signal.rows(), signal.cols());
}

// 0, 1, 2, … for all samples.
Eigen::ArrayXd counted() {
  return Eigen::ArrayXd::LinSpaced(kSamples, 0.0, kSamples - 1.0);
}

// Commands and effectiveness of the thrusters, before the drive.
struct Trip {
  explicit Trip(RandomStream& random) {
    Array3d goal = Array3d::Zero();
    Array3d command = Array3d::Zero();
    for (Index i = 0; i < kSamples; ++i) {
      if (i % kGoalEvery == 0) {
        goal = drawn(3, 1, [&] { return random.uniform(-1.0, 1.0); });
      }
      command += 0.25 * (goal - command) + 0.02 * normals(random, 3, 1);
      commands.col(i) = command;
    }
  }

  Signals commands{3, kSamples};
  Signals gains = Signals::Ones(3, kSamples);
};

// Two thrusters push ahead, with a moment, the third one sideways.
Array3d acceleration(const Array3d& velocity, const Array3d& command, const Array3d& gain) {
  const Array3d wanted =
      gain * (command > 0.0).select(Array3d::Ones(), 0.8) * command * command.abs();
  const Array3d thrust = kMostThrust * (wanted / kMostThrust).tanh();
  const double u = velocity[0];
  const double v = velocity[1];
  const double r = velocity[2];
  return {0.9 * (thrust[0] + thrust[1]) - 0.3 * u - 1.1 * u * std::abs(u) + 0.6 * v * r,
          thrust[2] - 0.4 * v - 1.6 * v * std::abs(v) - 0.7 * u * r - 0.5 * std::abs(r) * v,
          1.3 * (thrust[1] - thrust[0]) - 0.5 * thrust[2] - 0.5 * r - 1.2 * r * std::abs(r) +
              0.25 * std::tanh(3.0 * u) * v};
}

HostileStream drive(const Trip& trip, RandomStream& random) {
  HostileStream stream{.times_s = kPeriodS * counted(),
                       .x = Signals(6, kSamples),
                       .y = {},
                       .truth = Signals(3, kSamples)};
  Array3d velocity = Array3d::Zero();
  for (Index i = 0; i < kSamples; ++i) {
    stream.x.col(i) << velocity, trip.commands.col(i);
    stream.truth.col(i) = acceleration(velocity, trip.commands.col(i), trip.gains.col(i));
    velocity = (velocity + kPeriodS * stream.truth.col(i)).max(-kMostSpeed).min(kMostSpeed);
  }
  stream.y = stream.truth + noise(random, stream.truth, 0.05);
  stream.x.topRows(3) += noise(random, stream.x.topRows(3), 0.01);
  return stream;
}

// One target, linear in waves of three slow frequencies each; the inputs are the waves, mixed.
HostileStream swing(RandomStream& random, const Eigen::MatrixXd& mixing) {
  HostileStream stream{.inputs = {},
                       .targets = {"y"},
                       .velocities = 0,
                       .times_s = kPeriodS * counted(),
                       .x = {},
                       .y = {},
                       .truth = {}};
  Eigen::MatrixXd waves = Eigen::MatrixXd::Zero(mixing.cols(), kSamples);
  for (Index i = 0; i < 3 * waves.rows(); ++i) {
    const double frequency = random.uniform(0.05, 0.8);
    const double phase = random.uniform(0.0, 6.0);
    waves.row(i / 3).array() += (frequency * stream.times_s + phase).sin().transpose();
  }
  stream.x = mixing * waves;
  stream.y = stream.truth = normals(random, 1, waves.rows()).matrix() * waves;
  for (Index i = 0; i < mixing.rows(); ++i) {
    stream.inputs.push_back("x" + std::to_string(i));
  }
  return stream;
}

// A kind with another drive.
template <typename Steer>
HostileKind steered(std::string name, std::string meaning, Steer steer) {
  return {std::move(name), std::move(meaning), [steer](RandomStream& random) {
            Trip trip(random);
            steer(trip, random);
            return drive(trip, random);
          }};
}

// A kind that spoils what was recorded.
template <typename Spoil>
HostileKind spoiled(std::string name, std::string meaning, Spoil spoil) {
  return {std::move(name), std::move(meaning), [spoil](RandomStream& random) {
            HostileStream stream = drive(Trip(random), random);
            spoil(stream, random);
            return stream;
          }};
}

auto flapping(Index period) {
  return [period](Trip& trip, auto&) {
    for (Index i = period; i < kSamples; i += 2 * period) {
      trip.gains.row(0).segment(i, std::min(period, kSamples - i)) = 0.2;
    }
  };
}

template <typename Change>
void change_all(HostileStream& stream, Change change) {
  std::ranges::for_each(std::array{&stream.x, &stream.y, &stream.truth},
                        [&](Signals* signals) { change(*signals); });
}

auto yaw_in_degrees(Index begin) {
  return [begin](HostileStream& stream, auto&) {
    change_all(stream, [begin](Signals& signals) {
      signals.row(2).segment(begin, kSamples / 2) *= 180.0 / pi;
    });
  };
}

// The targets are now of another law of the inputs.
void obey(HostileStream& stream, RandomStream& random, const Signals& law) {
  stream.truth = law;
  stream.y = law + noise(random, law, 0.05);
}

Signals clipped(const Signals& signals) {
  const Signals most = (0.7 * deviations(signals)).replicate(1, signals.cols());
  return signals.max(-most).min(most);
}

Signals rounded(const Signals& signals, double deviation) {
  const Signals step = (deviation * deviations(signals)).replicate(1, signals.cols());
  return step * (signals / step).rint();
}

void hide(HostileStream& stream, Index begin, Index count) {
  std::fill_n(stream.hidden.begin() + begin, count, true);
}

void mirror_surge(HostileStream& stream, Index begin, Index count) {
  stream.x.row(0).segment(begin, count) *= -1.0;
  hide(stream, begin, count);
}

// Normal random numbers instead of inputs and targets.
auto garbage(Index begin, Index count, double size) {
  return [=](HostileStream& stream, RandomStream& random) {
    stream.x.middleCols(begin, count) = size * normals(random, 6, count);
    stream.y.middleCols(begin, count) = size * normals(random, 3, count);
    hide(stream, begin, count);
  };
}

// Targets of so many standard deviations, off the middle by `bias`; `growing`: of those so far,
// bursts included.
auto bursts(Index begin, Index count, Index every, double deviation, double bias, bool growing) {
  return [=](HostileStream& stream, RandomStream& random) {
    Eigen::ArrayXd size = deviations(stream.y);
    for (Index i = begin; i < kSamples; i += every) {
      stream.y.middleCols(i, count) =
          (deviation * normals(random, 3, count) + bias).colwise() * size;
      size = growing ? deviations(stream.y) : size;
    }
  };
}

// Calls `spoil` with begin and size of gaps at random places.
template <typename Spoil>
void at_gaps(RandomStream& random, double mean, Spoil spoil) {
  const auto length = [&](double of) {
    return 1 + static_cast<Index>(-of * std::log(1.0 - random.uniform()));
  };
  for (Index i = length(80.0); i < kSamples; i += length(80.0)) {
    const Index count = std::min(length(mean), kSamples - i);
    spoil(i, count);
    i += count;
  }
}

std::vector<HostileKind> kinds_of_drives() {
  return {
      steered("clean", "no fault but noise", [](auto&, auto&) {}),
      steered("flapping_50", "th1 at 20 % every other 10 s", flapping(50)),
      steered("flapping_150", "th1 at 20 % every other 30 s", flapping(150)),
      steered("flapping_500", "th1 at 20 % every other 100 s", flapping(500)),
      steered("gain_wave", "thrust between 20 and 180 %, in waves of 140 s",
              [](auto& trip, auto&) {
                trip.gains.rowwise() += 0.8 * (counted() * (2.0 * pi / 700.0)).sin().transpose();
              }),
      steered("random_switches", "thrust between −100 and 150 %, another every 10 to 100 s",
              [](auto& trip, auto& random) {
                Array3d gain = Array3d::Ones();
                for (Index i = 0, next = 0; i < kSamples; ++i) {
                  if (i == next) {
                    next += static_cast<Index>(random.uniform(50.0, 500.0));
                    gain = drawn(3, 1, [&] { return random.uniform(-1.0, 1.5); });
                  }
                  trip.gains.col(i) = gain;
                }
              }),
      steered("scale_growth", "commands of a tenth, then twelve times as large",
              [](auto& trip, auto&) {
                trip.commands.leftCols(kSamples / 2) *= 0.1;
                trip.commands.rightCols(kSamples / 2) *= 1.2;
              }),
      steered("periodic", "commands in waves of 8 and 4 s",
              [](auto& trip, auto&) {
                const auto phase = (counted() * (2.0 * pi / 40.0)).transpose().eval();
                trip.commands << phase.sin(), (phase + 0.5).sin(), (2.0 * phase).sin();
              }),
      steered("collinear", "one command for all thrusters, to 1e-7",
              [](auto& trip, auto& random) {
                trip.commands.row(1) = trip.commands.row(0) + 1e-7 * normals(random, 1, kSamples);
                trip.commands.row(2) = -trip.commands.row(0);
              }),
      steered("constant_then_moves", "th3 constant for three quarters of the stream",
              [](auto& trip, auto&) { trip.commands.row(2).head(3 * kSamples / 4) = 0.5; }),
      {"rest_first", "half of the stream at rest",
       [](RandomStream& random) {
         Trip trip(random);
         trip.commands.leftCols(kSamples / 2) = 0.0;
         HostileStream stream = drive(trip, random);
         stream.x += 1e-4 * normals(random, 6, kSamples);
         return stream;
       }},
      {"many_inputs", "64 inputs that swing slowly, a linear target",
       [](RandomStream& random) { return swing(random, Eigen::MatrixXd::Identity(64, 64)); }},
      {"equal_inputs", "64 equal inputs, a linear target",
       [](RandomStream& random) { return swing(random, Eigen::MatrixXd::Ones(64, 1)); }},
  };
}

std::vector<HostileKind> kinds_of_sensors() {
  return {
      spoiled("exponential_growth", "inputs and targets grow by e every 80 s",
              [](auto& s, auto&) {
                change_all(s, [&](Signals& signals) {
                  signals.rowwise() *= (s.times_s / 80.0).exp().transpose();
                });
              }),
      spoiled("relay_target", "targets are signs",
              [](auto& s, auto&) {
                s.y = s.y.sign();
                s.truth = s.truth.sign();
              }),
      spoiled("quantised", "inputs and targets in steps of half a standard deviation",
              [](auto& s, auto&) {
                s.x = rounded(s.x, 0.5);
                s.y = rounded(s.y, 0.5);
              }),
      spoiled("quantised_target_only", "targets in steps of a standard deviation",
              [](auto& s, auto&) { s.y = rounded(s.y, 1.0); }),
      spoiled("clipped", "velocities and targets end at 0.7 standard deviations",
              [](auto& s, auto&) {
                s.x.topRows(3) = clipped(s.x.topRows(3));
                s.y = clipped(s.y);
                s.truth = clipped(s.truth);
              }),
      spoiled("moving_delay", "commands 0 to 1.2 s late, in waves of six minutes",
              [](auto& s, auto&) {
                const Eigen::ArrayXd late = (3.0 + 3.0 * (counted() / 300.0).sin()).rint();
                for (Index i = kSamples - 1; i >= 0; --i) {
                  s.x.col(i).tail(3) =
                      s.x.col(std::max<Index>(0, i - static_cast<Index>(late[i]))).tail(3);
                }
              }),
      spoiled("held_20_rows", "every sample 20 times",
              [](auto& s, auto&) {
                change_all(s, [](Signals& signals) {
                  for (Index i = 0; i < kSamples; ++i) {
                    signals.col(i) = signals.col(i - i % 20);
                  }
                });
              }),
      spoiled("gaps_of_a_day", "a day without samples every 100 s",
              [](auto& s, auto&) { s.times_s += 86400.0 * (counted() / 500.0).floor(); }),
      spoiled("counter_input", "a counter in place of th3",
              [](auto& s, auto&) { s.x.row(5) = counted().transpose(); }),
      spoiled("wrapped_heading", "an angle between −π and π in place of th3",
              [](auto& s, auto&) {
                double heading = 0.0;
                for (Index i = 0; i < kSamples; ++i) {
                  heading += 3.0 * kPeriodS * s.x(2, i);
                  s.x(5, i) = wrapped(heading);
                }
              }),
      spoiled("deg_to_rad", "yaw in degrees, from the middle on in radians", yaw_in_degrees(0)),
      spoiled("rad_to_deg", "yaw in radians, from the middle on in degrees",
              yaw_in_degrees(kSamples / 2)),
  };
}

std::vector<HostileKind> kinds_of_noise() {
  return {
      spoiled("cauchy", "Cauchy's noise on targets",
              [](auto& s, auto& random) { s.y += cauchy_noise(random, s.y, 0.1); }),
      spoiled("cauchy_inputs", "Cauchy's noise on velocities",
              [](auto& s, auto& random) {
                s.x.topRows(3) += cauchy_noise(random, s.x.topRows(3), 0.03);
              }),
      spoiled("noise_only", "targets are noise, the truth too",
              [](auto& s, auto& random) { s.y = s.truth = normals(random, 3, kSamples); }),
      spoiled("mostly_noise", "noise of 5 standard deviations on targets",
              [](auto& s, auto& random) { s.y += noise(random, s.y, 5.0); }),
      spoiled("coloured_noise", "noise with a memory of 40 s on targets",
              [](auto& s, auto& random) {
                Signals drift = noise(random, s.y, 0.15);
                for (Index i = 1; i < kSamples; ++i) {
                  drift.col(i) += 0.995 * drift.col(i - 1);
                }
                s.y += drift;
              }),
      spoiled("bias_steps", "a new bias of the targets every 80 s, the truth too",
              [](auto& s, auto& random) {
                const Signals bias = noise(random, s.y, 1.0);
                for (Index i = 0; i < kSamples; ++i) {
                  s.y.col(i) += bias.col(i / 400);
                  s.truth.col(i) += bias.col(i / 400);
                }
              }),
      spoiled("two_laws", "the vehicle, then a law for kernels alone, every other 80 s",
              [](auto& s, auto& random) {
                Signals law(3, kSamples);
                law << (3.0 * s.x.row(0)).sin() + (4.0 * s.x.row(3)).cos(),
                    (5.0 * s.x.row(4)).sin() * s.x.row(1),
                    (3.0 * s.x.row(2) + 2.0 * s.x.row(5)).cos();
                law.colwise() *= deviations(s.truth);
                for (Index i = 0; i < kSamples; i += 800) {
                  law.middleCols(i, 400) = s.truth.middleCols(i, 400);
                }
                obey(s, random, law);
              }),
      spoiled("chirp_law", "targets swing many times over the inputs",
              [](auto& s, auto& random) {
                Signals law(3, kSamples);
                law << (12.0 * s.x.row(0)).sin(), (12.0 * s.x.row(3)).sin(),
                    (9.0 * s.x.row(2) * s.x.row(4)).sin();
                obey(s, random, law);
              }),
  };
}

std::vector<HostileKind> kinds_of_faults() {
  return {
      spoiled("identical_first", "half of the stream one sample, again and again",
              [](auto& s, auto&) {
                s.x.leftCols(kSamples / 2) = 0.1;
                s.y.leftCols(kSamples / 2) = 0.2;
                hide(s, 0, kSamples / 2);
              }),
      spoiled("dropouts_zero", "inputs 0 for some seconds, again and again",
              [](auto& s, auto& random) {
                at_gaps(random, 12.0, [&](Index begin, Index count) {
                  s.x.middleCols(begin, count) = 0.0;
                  hide(s, begin, count);
                });
              }),
      spoiled("dropouts_target_zero", "targets 0 for some seconds, again and again",
              [](auto& s, auto& random) {
                at_gaps(random, 30.0,
                        [&](Index begin, Index count) { s.y.middleCols(begin, count) = 0.0; });
              }),
      spoiled("sign_flip_minute", "surge with the wrong sign for a minute",
              [](auto& s, auto&) { mirror_surge(s, 2000, kMinute); }),
      spoiled("sign_flips_many", "surge with the wrong sign for 30 s, every two minutes",
              [](auto& s, auto&) {
                for (Index i = 600; i < kSamples; i += 600) {
                  mirror_surge(s, i, 150);
                }
              }),
      spoiled("half_outliers", "half of the targets, at random, of 10 standard deviations",
              [](auto& s, auto& random) {
                const Signals outliers = noise(random, s.y, 10.0);
                for (Index i = 0; i < kSamples; ++i) {
                  if (random.uniform() < 0.5) {
                    s.y.col(i) = outliers.col(i);
                  }
                }
              }),
      spoiled("bursts_of_five", "targets of 100 standard deviations for 1 s, every 20 s",
              bursts(kMinute, 5, 100, 0.0, 100.0, false)),
      spoiled("outlier_bursts", "targets of about 30 standard deviations for 8 s, every minute",
              bursts(kMinute, 40, kMinute, 20.0, 30.0, false)),
      spoiled("outlier_bursts_growing", "the same, in deviations of the bursts before",
              bursts(kMinute, 40, kMinute, 20.0, 30.0, true)),
      spoiled("one_burst", "targets of 1e6 standard deviations for 8 s, after five minutes",
              bursts(1500, 40, kSamples, 1e6, 0.0, false)),
      spoiled("garbage_first_targets", "targets of 100 standard deviations for the first 12 s",
              bursts(0, 60, kSamples, 100.0, 0.0, false)),
      spoiled("garbage_midway", "inputs and targets of 1e6 for 30 s in the middle",
              garbage(kSamples / 2, 150, 1e6)),
      spoiled("garbage_first_30s", "inputs and targets of 1e6 for the first 30 s",
              garbage(0, 150, 1e6)),
      spoiled("garbage_first", "inputs and targets of 1e6 for the first 12 s", garbage(0, 60, 1e6)),
      spoiled("garbage_first_20", "inputs and targets of 1e6 for the first 4 s",
              garbage(0, 20, 1e6)),
      spoiled("garbage_first_1000x", "inputs and targets of 1e3 for the first 12 s",
              garbage(0, 60, 1e3)),
      spoiled("garbage_first_tiny", "inputs and targets of 1e-9 for the first 12 s",
              garbage(0, 60, 1e-9)),
  };
}

}  // namespace

HostileStream HostileKind::stream(std::uint64_t seed) const {
  RandomStream random(seed, "hostile/" + name);
  return make(random);
}

std::vector<HostileKind> hostile_kinds() {
  std::vector<HostileKind> kinds = kinds_of_drives();
  for (auto* more : {kinds_of_sensors, kinds_of_noise, kinds_of_faults}) {
    std::ranges::move(more(), std::back_inserter(kinds));
  }
  return kinds;
}

}  // namespace kelpie::lab
