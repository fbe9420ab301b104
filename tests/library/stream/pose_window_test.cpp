// SPDX-License-Identifier: Apache-2.0
#include "stream/pose_window.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "kelpie/stream/sample_stream.hpp"
#include "support.hpp"

namespace kelpie::pose_window_test {
namespace {

using Curve = std::function<double(double)>;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kHalf = 1.0;

// A recorded source: its curve, rate, first stamp, and how far a stamp is off the even spacing.
struct Recorded {
  std::string name;
  Curve curve;
  double rate_hz = 20.0;
  double first_s = 0.0;
  double uneven = 0.0;
  Interpolation between = Interpolation::line;
};

struct Rows {
  std::vector<double> times_s;
  std::vector<std::vector<double>> columns;  // as the plan's inputs
  std::size_t whole = 0;
};

StreamPlan plan_of(const std::vector<Recorded>& sources, const StreamPlan::Pose& pose) {
  StreamPlan plan;
  for (const Recorded& source : sources) {
    plan.sources.push_back({.name = source.name, .between = source.between, .keep = 4096});
  }
  plan.pose = pose;
  plan.pose->half_s = kHalf;
  plan.rate_hz = 4.0;
  plan.inputs = plan.pose->columns();
  return plan;
}

// The rows of sources over 20 s.
Rows rows_of(const StreamPlan& plan, const std::vector<Recorded>& sources) {
  struct Sample {
    double t;
    std::size_t source;
    double value;
  };
  std::vector<Sample> samples;
  RandomStream random(7, "pose");
  for (std::size_t k = 0; k < sources.size(); ++k) {
    const Recorded& source = sources[k];
    for (double even = source.first_s; even <= 20.0; even += 1.0 / source.rate_hz) {
      const double t = even + source.uneven * random.uniform(0.0, 1.0) / source.rate_hz;
      samples.push_back({t, k, source.curve(t)});
    }
  }
  std::ranges::stable_sort(samples, {}, &Sample::t);
  SampleStream stream(plan);
  Rows rows;
  rows.columns.resize(plan.inputs.size());
  const auto take = [&] {
    while (const auto* const row = stream.next()) {
      rows.times_s.push_back(row->t);
      rows.whole += row->is_whole ? 1 : 0;
      for (std::size_t i = 0; i < rows.columns.size(); ++i) {
        rows.columns[i].push_back(row->x[i]);
      }
    }
  };
  for (const Sample& sample : samples) {
    stream.feed(sample.source, sample.t, sample.value);
    take();
  }
  stream.finish();
  take();
  return rows;
}

const std::vector<double>& column(const StreamPlan& plan, const Rows& rows,
                                  const std::string& name) {
  const auto found = std::ranges::find(plan.inputs, name);
  return rows.columns.at(static_cast<std::size_t>(found - plan.inputs.begin()));
}

void expect_near(const std::vector<double>& values, const Rows& rows, const Curve& truth,
                 double error) {
  std::size_t finite = 0;
  for (std::size_t row = 0; row < values.size(); ++row) {
    if (std::isfinite(values[row])) {
      EXPECT_NEAR(values[row], truth(rows.times_s[row]), error) << "at " << rows.times_s[row];
      ++finite;
    }
  }
  EXPECT_GT(finite, 50U);
}

double wrapped(double angle) {
  return std::remainder(angle, 2.0 * std::numbers::pi);
}

const StreamPlan::Pose kPlane{.position = {"x", "y", ""}, .attitude = {"", "", "psi"}};

TEST(PoseKernel, HasUnitIntegralNoSecondMomentAndItsSlope) {
  double area = 0.0;
  double second = 0.0;
  const int steps = 20000;
  for (int i = 0; i < steps; ++i) {
    const double s = (2.0 * i + 1.0) / steps - 1.0;
    area += PoseKernel::weight(s) * 2.0 / steps;
    second += s * s * PoseKernel::weight(s) * 2.0 / steps;
    EXPECT_NEAR(PoseKernel::slope(s),
                (PoseKernel::weight(s + 1e-6) - PoseKernel::weight(s - 1e-6)) / 2e-6, 1e-4);
    EXPECT_NEAR(PoseKernel::integral(s) - PoseKernel::integral(-1.0), area, 2e-4);
  }
  EXPECT_NEAR(area, 1.0, 1e-6);
  EXPECT_NEAR(second, 0.0, 1e-6);
  EXPECT_EQ(PoseKernel::weight(1.5), 0.0);
}

// On a circle with growing speed the truth is known: x' = u cos ψ, ψ' = r, u = 0.4 + 0.02 t.
TEST(PoseWindow, KnowsVelocitiesAndAccelerationsOfAnAnalyticPath) {
  const double r = 0.5;
  const auto u = [](double t) { return 0.4 + 0.02 * t; };
  const auto psi = [&](double t) { return wrapped(1.0 + r * t); };
  const Curve x = [&](double t) {  // ∫ (0.4 + 0.02 t) cos(1 + r t) dt
    return u(t) * std::sin(1.0 + r * t) / r + 0.02 * std::cos(1.0 + r * t) / (r * r);
  };
  const Curve y = [&](double t) {
    return -u(t) * std::cos(1.0 + r * t) / r + 0.02 * std::sin(1.0 + r * t) / (r * r);
  };
  // Clocks of their own, uneven steps, and a heading that jumps from π to −π.
  const std::vector<Recorded> sources{
      {"x", x, 20.0, 0.0, 0.3}, {"y", y, 17.0, 0.013, 0.3}, {"psi", psi, 11.0, 0.02, 0.2}};
  const StreamPlan plan = plan_of(sources, kPlane);
  const Rows rows = rows_of(plan, sources);
  EXPECT_EQ(plan.inputs, (std::vector<std::string>{"u", "v", "r", "udot", "vdot", "rdot"}));
  expect_near(column(plan, rows, "u"), rows, u, 3e-4);
  expect_near(
      column(plan, rows, "v"), rows, [](double) { return 0.0; }, 3e-4);
  expect_near(
      column(plan, rows, "r"), rows, [&](double) { return r; }, 1e-9);
  expect_near(
      column(plan, rows, "udot"), rows, [](double) { return 0.02; }, 2e-3);
  expect_near(
      column(plan, rows, "vdot"), rows, [](double) { return 0.0; }, 2e-3);
  expect_near(
      column(plan, rows, "rdot"), rows, [](double) { return 0.0; }, 1e-8);
}

TEST(PoseWindow, AnOffsetOrATurnOfTheWorldChangesNothing) {
  const Curve x = [](double t) { return std::sin(0.4 * t) + 0.1 * t; };
  const Curve y = [](double t) { return std::cos(0.3 * t); };
  const Curve psi = [](double t) { return 2.0 * std::sin(0.2 * t); };
  const double turn = 2.0;
  const auto turned = [&](double sign, const Curve& a, const Curve& b) -> Curve {
    return [=](double t) { return 1e4 + std::cos(turn) * a(t) + sign * std::sin(turn) * b(t); };
  };
  const std::vector<Recorded> here{{"x", x}, {"y", y}, {"psi", psi}};
  const std::vector<Recorded> there{{"x", turned(-1.0, x, y)},
                                    {"y", turned(1.0, y, x)},
                                    {"psi", [&](double t) { return wrapped(psi(t) + turn); }}};
  const StreamPlan plan = plan_of(here, kPlane);
  const Rows first = rows_of(plan, here);
  const Rows second = rows_of(plan, there);
  for (std::size_t k = 0; k < plan.inputs.size(); ++k) {
    expect_near(
        second.columns[k], second,
        [&](double t) {
          const auto row = std::ranges::find(first.times_s, t) - first.times_s.begin();
          return first.columns[k].at(static_cast<std::size_t>(row));
        },
        1e-7);
  }
}

// Roll, pitch and yaw of a body that turns about its own z axis at a constant attitude of the axis.
TEST(PoseWindow, RatesOfTheBodyComeFromAnglesAndFromQuaternionsAlike) {
  const Curve roll = [](double t) { return 0.2 * std::sin(0.5 * t); };
  const Curve pitch = [](double t) { return 0.3 * std::cos(0.4 * t); };
  const Curve yaw = [](double t) { return wrapped(0.6 * t); };
  const auto part = [=](std::size_t i) -> Curve {
    return [=](double t) {
      const double cr = std::cos(0.5 * roll(t)), sr = std::sin(0.5 * roll(t));
      const double cp = std::cos(0.5 * pitch(t)), sp = std::sin(0.5 * pitch(t));
      const double cy = std::cos(0.5 * yaw(t)), sy = std::sin(0.5 * yaw(t));
      const std::array<double, 4> q{cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy,
                                    cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy};
      return q.at(i);
    };
  };
  const std::vector<Recorded> angles{{"phi", roll}, {"theta", pitch}, {"psi", yaw}};
  const std::vector<Recorded> quaternion{
      {"qw", part(0)}, {"qx", part(1)}, {"qy", part(2)}, {"qz", part(3)}};
  const StreamPlan by_angles =
      plan_of(angles, {.attitude = {"phi", "theta", "psi"}, .has_tilt_rates = true});
  const StreamPlan by_quaternion =
      plan_of(quaternion, {.attitude = {"qw", "qx", "qy", "qz"}, .has_tilt_rates = true});
  const Rows first = rows_of(by_angles, angles);
  const Rows second = rows_of(by_quaternion, quaternion);
  const Curve p = [&](double t) { return 0.1 * std::cos(0.5 * t) - 0.6 * std::sin(pitch(t)); };
  for (const auto& [plan, rows] : {std::pair(by_angles, first), std::pair(by_quaternion, second)}) {
    expect_near(column(plan, rows, "p"), rows, p, 2e-3);
    expect_near(
        column(plan, rows, "r"), rows,
        [&](double t) {
          return 0.6 * std::cos(roll(t)) * std::cos(pitch(t)) +
                 std::sin(roll(t)) * 0.12 * std::sin(0.4 * t);
        },
        2e-3);
  }
  expect_near(column(by_quaternion, second, "theta"), second, pitch, 1e-3);
}

TEST(PoseWindow, PartsOfAPoseGiveWhatTheyCan) {
  const std::vector<Recorded> depth{{"z", [](double t) { return 3.0 + 0.2 * t + 0.05 * t * t; }}};
  const StreamPlan plan = plan_of(depth, {.position = {"", "", "z"}});
  EXPECT_EQ(plan.inputs, (std::vector<std::string>{"w", "wdot"}));
  const Rows rows = rows_of(plan, depth);
  expect_near(
      column(plan, rows, "w"), rows, [](double t) { return 0.2 + 0.1 * t; }, 1e-8);
  expect_near(
      column(plan, rows, "wdot"), rows, [](double) { return 0.1; }, 1e-8);
  const StreamPlan heading = plan_of({{"psi", {}}}, {.attitude = {"", "", "psi"}});
  EXPECT_EQ(heading.inputs, (std::vector<std::string>{"r", "rdot"}));
}

// All signals of a row have the weights of the pose, so a linear equation holds without bias.
TEST(PoseWindow, CommandsAndStatesAreMeansWithTheSameWeights) {
  const std::vector<Recorded> sources{
      {"z", [](double t) { return t; }},
      {"n", [](double t) { return t < 9.9 ? 0.0 : 4.0; }, 5.0, 0.0, 0.0, Interpolation::hold},
      {"phi", [](double t) { return wrapped(3.1 + 0.02 * t); }},
      {"volts", [](double t) { return 2.0 * t; }, 5.0, 0.0, 0.0, Interpolation::curve}};
  StreamPlan plan = plan_of(sources, {.position = {"", "", "z"}, .attitude = {"phi", "", ""}});
  plan.inputs = {"w", "n", "phi", "volts"};
  const Rows rows = rows_of(plan, sources);
  expect_near(
      column(plan, rows, "n"), rows,
      [](double t) {
        return 4.0 * (PoseKernel::integral(1.0) - PoseKernel::integral((10.0 - t) / kHalf));
      },
      1e-9);
  expect_near(
      column(plan, rows, "phi"), rows, [](double t) { return wrapped(3.1 + 0.02 * t); }, 1e-3);
  expect_near(
      column(plan, rows, "volts"), rows, [](double t) { return 2.0 * t; }, 1e-3);
}

TEST(PoseWindow, ASilenceOrAMissingValueMakesNoRowOverIt) {
  const std::vector<Recorded> sources{
      {"z", [](double t) { return t > 8.0 && t < 11.0 ? kNaN : t; }}};
  const StreamPlan plan = plan_of(sources, {.position = {"", "", "z"}});
  const Rows rows = rows_of(plan, sources);
  for (std::size_t row = 0; row < rows.times_s.size(); ++row) {
    const double t = rows.times_s[row];
    const bool is_near = t > 8.0 - kHalf + 0.1 && t < 11.0 + kHalf - 0.1;
    const bool is_inside = t > kHalf + 0.1 && t < 20.0 - kHalf - 0.1;
    if (is_near) {
      EXPECT_TRUE(std::isnan(rows.columns[0][row])) << t;
    } else if (is_inside && (t < 6.9 || t > 12.1)) {
      EXPECT_NEAR(rows.columns[0][row], 1.0, 1e-9) << t;
    }
  }
}

TEST(PoseWindow, SaysWhichPoseIsNone) {
  const auto refusal = [](const StreamPlan::Pose& pose, bool derives = false) {
    StreamPlan plan = plan_of({{"x", {}}, {"y", {}}, {"z", {}}, {"psi", {}}}, pose);
    plan.inputs = {"psi"};
    if (derives) {
      plan.derived = {{"xdot", "x"}};
    }
    return testing::message_of<InputError>([&] { plan.validate(); });
  };
  EXPECT_NE(refusal({.position = {"x", "", ""}}).find("x and y belong together"),
            std::string::npos);
  EXPECT_NE(refusal({.position = {"x", "y", ""}}).find("a yaw"), std::string::npos);
  EXPECT_NE(refusal({.attitude = {"psi", "", ""}}).find("measures no motion"), std::string::npos);
  EXPECT_NE(refusal({.attitude = {"psi"}}).find("quaternion"), std::string::npos);
  EXPECT_NE(refusal({.position = {"", "", "depht"}}).find("depht"), std::string::npos);
  EXPECT_NE(refusal(kPlane, true).find("derivative beside a pose"), std::string::npos);
  EXPECT_EQ(refusal(kPlane), "");
  StreamPlan open = plan_of({{"z", {}}}, {.position = {"", "", "z"}});
  open.pose->half_s = 0.0;
  EXPECT_NE(
      testing::message_of<InputError>([&] { const SampleStream stream(open); }).find("window"),
      std::string::npos);
}

}  // namespace
}  // namespace kelpie::pose_window_test
