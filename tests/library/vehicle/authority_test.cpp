// SPDX-License-Identifier: Apache-2.0
// What the thrusters can still do, and commands for wanted accelerations.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/bounded_minimum.hpp"
#include "core/eigen.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "kelpie/vehicle/diagnosis.hpp"
#include "linear_algebra.hpp"
#include "support.hpp"
#include "vehicle/four_thrusters.hpp"

namespace kelpie::authority_test {
namespace {

using testing::message_of;
using Vehicle = testing::FourThrusters;

// All active sets of a small problem: each variable free, at its lower or at its upper bound.
double least_by_trying_all(const Eigen::MatrixXd& h, const Eigen::VectorXd& g,
                           const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  const auto n = static_cast<int>(g.size());
  double least = std::numeric_limits<double>::infinity();
  int sets = 1;
  for (int i = 0; i < n; ++i) {
    sets *= 3;
  }
  for (int set = 0; set < sets; ++set) {
    Eigen::VectorXd z = lower;
    std::vector<Eigen::Index> free;
    for (int i = 0, rest = set; i < n; ++i, rest /= 3) {
      if (rest % 3 == 1) {
        z(i) = upper(i);
      } else if (rest % 3 == 2) {
        free.push_back(i);
        z(i) = 0.0;
      }
    }
    if (!free.empty()) {
      const Eigen::VectorXd right = (g - h * z)(free);
      const Eigen::VectorXd solved = testing::least_squares(h(free, free), right);
      z(free) = solved;
    }
    if ((z.array() >= lower.array() - 1e-12).all() && (z.array() <= upper.array() + 1e-12).all()) {
      least = std::min(least, 0.5 * z.dot(h * z) - g.dot(z));
    }
  }
  return least;
}

TEST(BoundedMinimum, IsTheLeastOfAllActiveSetsAndSatisfiesTheKktConditions) {
  RandomStream random(1, "boxes");
  for (int round = 0; round < 300; ++round) {
    const Eigen::Index n = 1 + round % 6;
    Eigen::MatrixXd b(3, n);
    Eigen::VectorXd tau(3);
    for (double& value : b.reshaped()) {
      value = random.normal();
    }
    for (double& value : tau) {
      value = 3.0 * random.normal();
    }
    Eigen::MatrixXd h = b.transpose() * b;
    h.diagonal().array() += 1e-6;
    const Eigen::VectorXd g = b.transpose() * tau;
    Eigen::VectorXd lower = Eigen::VectorXd::Constant(n, -1.0);
    Eigen::VectorXd upper = Eigen::VectorXd::Ones(n);
    if (round % 5 == 0) {
      upper(0) = lower(0);  // a dead thruster
    }
    Eigen::VectorXd z(n);
    const auto numbers = [](auto& of) {
      return std::span(of.data(), static_cast<std::size_t>(of.size()));
    };
    bounded_minimum(numbers(h), numbers(g), numbers(lower), numbers(upper), numbers(z));
    EXPECT_NEAR(0.5 * z.dot(h * z) - g.dot(z), least_by_trying_all(h, g, lower, upper), 1e-8);
    const Eigen::VectorXd slope = h * z - g;
    for (Eigen::Index i = 0; i < n; ++i) {
      EXPECT_GE(z(i), lower(i));
      EXPECT_LE(z(i), upper(i));
      if (z(i) > lower(i)) {
        EXPECT_LE(slope(i), 1e-8);
      }
      if (z(i) < upper(i)) {
        EXPECT_GE(slope(i), -1e-8);
      }
    }
  }
}

TEST(Authority, OfTheWholeVehicleIsNominal) {
  Vehicle vehicle(1);
  Diagnosis learned = Vehicle::diagnosis();
  EXPECT_EQ(message_of<InputError>([&] { const Authority none(learned, Vehicle::ranges()); }),
            "diagnosis: knows too little of the vehicle so far: it takes some minutes of driving");
  vehicle.drive(learned, 600.0);
  const Authority authority(learned, Vehicle::ranges());
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(authority.axes()[i].most, vehicle.attainable(i), 0.03 * vehicle.attainable(i));
    EXPECT_NEAR(authority.axes()[i].least, -vehicle.attainable(i), 0.03 * vehicle.attainable(i));
    EXPECT_DOUBLE_EQ(authority.axes()[i].left(), 1.0);
    EXPECT_NEAR(authority.axes()[i].alone_most, authority.axes()[i].most,
                0.05 * authority.axes()[i].most);
  }
  EXPECT_EQ(authority.lost_axis(), 3U);
  EXPECT_EQ(authority.text({Vehicle::kInputs, Vehicle::kTargets})
                .find("no thruster is known to have changed"),
            0U);
  EXPECT_TRUE(authority.text({Vehicle::kInputs, Vehicle::kTargets}).ends_with(" from ahead"));
  EXPECT_TRUE(
      authority.text({Vehicle::kInputs, Vehicle::kTargets}, "m/s").ends_with(" m/s from ahead"));
  // 0.64 m/s² of thrust against 0.2 V + 0.8 V².
  EXPECT_NEAR(authority.held_current(), 0.78, 0.04);
  for (const ThrusterEffect& one : authority.thrusters()) {
    EXPECT_NEAR(one.share, 1.0, 1e-9);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_GT(one.ahead_width[i], 0.0);
      EXPECT_LT(one.ahead_width[i], 0.05);
    }
  }
}

// One thruster or two, at 0 to 80 %: the envelope 60 s after the change is that of the vehicle.
TEST(Authority, IsThatOfTheDamagedVehicleAMinuteAfterTheChange) {
  struct Damage {
    std::array<double, 4> share;
  };
  std::uint64_t seed = 20;
  for (const Damage& damage :
       {Damage{{0.0, 1.0, 1.0, 1.0}}, Damage{{1.0, 0.4, 1.0, 1.0}}, Damage{{1.0, 1.0, 0.8, 1.0}},
        Damage{{0.5, 1.0, 0.2, 1.0}}, Damage{{1.0, 0.6, 1.0, 0.0}}}) {
    Vehicle vehicle(seed++);
    Diagnosis learned = Vehicle::diagnosis();
    vehicle.drive(learned, 600.0);
    vehicle.share = damage.share;
    for (const double seconds : {60.0, 200.0}) {  // before and after the change is settled
      vehicle.drive(learned, seconds);
      const Authority authority(learned, Vehicle::ranges());
      for (std::size_t i = 0; i < 3; ++i) {
        const double nominal = Vehicle(1).attainable(i);
        EXPECT_NEAR(authority.axes()[i].most, vehicle.attainable(i), 0.05 * nominal) << seconds;
        EXPECT_NEAR(authority.axes()[i].left(), vehicle.attainable(i) / nominal, 0.05) << seconds;
      }
      for (std::size_t j = 0; j < 4; ++j) {
        EXPECT_NEAR(authority.thrusters()[j].share, damage.share[j], 0.06) << j;
      }
    }
  }
}

// A push of the water turns in the body as the vehicle turns, and is none of the known causes.
TEST(Authority, AChangeWithoutANameTakesNoThrust) {
  for (const std::uint64_t seed : {40U, 41U, 42U, 43U}) {
    Vehicle vehicle(seed);
    Diagnosis learned = Vehicle::diagnosis();
    vehicle.drive(learned, 600.0);
    vehicle.push_m_s2 = 0.05;
    vehicle.effort = 1.5;
    for (int round = 0; round < 60; ++round) {
      vehicle.drive(learned, 10.0);
      const Authority authority(learned, Vehicle::ranges());
      for (const ThrusterEffect& one : authority.thrusters()) {
        EXPECT_NEAR(one.share, 1.0, 0.1) << seed << " after " << 10 * round << " s";
      }
    }
    EXPECT_GT(learned.found(), 0U);
    for (const Finding& finding : learned.findings()) {
      for (std::size_t i = 0; i < finding.count; ++i) {
        if (finding.causes[i].kind == CauseKind::load) {
          EXPECT_GT(finding.causes[i].size, 1.0 / 3.0);
          EXPECT_LT(finding.causes[i].size, 3.0);
        }
      }
    }
  }
}

// A propeller that was blocked runs again.
TEST(Authority, ADeadThrusterThatComesBackHasItsThrust) {
  Vehicle vehicle(45);
  Diagnosis learned = Vehicle::diagnosis();
  vehicle.drive(learned, 600.0);
  for (const double share : {0.0, 1.0, 0.5}) {
    vehicle.share[2] = share;
    vehicle.drive(learned, 300.0);
    EXPECT_NEAR(Authority(learned, Vehicle::ranges()).thrusters()[2].share, share, 0.06);
  }
}

// A controller that starts anew counts its time from 0.
TEST(Authority, ALossIsFoundWithAClockThatBeginsAnew) {
  Vehicle vehicle(44);
  Diagnosis learned = Vehicle::diagnosis();
  vehicle.drive(learned, 600.0);
  vehicle.t = 0.0;
  vehicle.drive(learned, 30.0);
  vehicle.share[1] = 0.4;
  vehicle.drive(learned, 60.0);
  EXPECT_NEAR(Authority(learned, Vehicle::ranges()).thrusters()[1].share, 0.4, 0.06);
}

TEST(Authority, CommandsGiveWhatIsWantedOfTheDamagedVehicle) {
  Vehicle vehicle(3);
  Diagnosis learned = Vehicle::diagnosis();
  vehicle.drive(learned, 600.0);
  vehicle.share = {0.5, 1.0, 1.0, 1.0};
  vehicle.drive(learned, 60.0);
  const Authority authority(learned, Vehicle::ranges());
  RandomStream random(4, "wanted");
  for (int round = 0; round < 200; ++round) {
    const std::array<double, 3> wanted{random.uniform(-0.2, 0.2), random.uniform(-0.3, 0.3),
                                       random.uniform(-0.2, 0.2)};
    const Allocation allocation = authority.allocate(wanted);
    EXPECT_LT(allocation.missing, 1e-3);
    for (std::size_t i = 0; i < 3; ++i) {
      double given = 0.0;
      for (std::size_t j = 0; j < 4; ++j) {
        const double n = allocation.commands[j];
        EXPECT_LE(std::abs(n), 4.0);
        given += vehicle.share[j] * Vehicle::kThrust[i][j] * n * std::abs(n);
      }
      EXPECT_NEAR(given, wanted[i], 0.04) << i;
    }
  }
  // Beyond all thrust: the greatest of the wanted direction that the weights allow.
  const Allocation far = authority.allocate(std::array{10.0, 0.0, 0.0});
  EXPECT_GT(far.missing, 1.0);
  EXPECT_LE(far.reached[0], authority.axes()[0].most + 1e-9);
  EXPECT_THROW(authority.allocate(std::array{1.0}), InputError);
  EXPECT_THROW(authority.allocate(std::array{1.0, std::nan(""), 0.0}), InputError);
}

// The warning first: a pilot's screen cuts long texts.
TEST(Authority, SaysWhatIsLostInWords) {
  Vehicle vehicle(5);
  Diagnosis learned = Vehicle::diagnosis();
  vehicle.drive(learned, 600.0);
  vehicle.share = {1.0, 1.0, 0.0, 0.0};
  vehicle.drive(learned, 60.0);
  const Authority authority(learned, Vehicle::ranges());
  const std::string text = authority.text({Vehicle::kInputs, Vehicle::kTargets}, "m/s");
  EXPECT_EQ(authority.lost_axis(), 1U) << text;
  EXPECT_TRUE(text.starts_with("NEARLY NO AUTHORITY left in sway; th")) << text;
  EXPECT_NE(text.find(": surge 1.0"), std::string::npos) << text;
  EXPECT_NE(text.find(", sway 0.0"), std::string::npos) << text;
  EXPECT_NE(text.find(", yaw 0.5"), std::string::npos) << text;
  EXPECT_LT(authority.singular_values().back(), 0.1 * authority.nominal_singular_values().back());
}

// Along or about an axis that no name tells.
TEST(Authority, CallsAnUnknownAxisByItsTarget) {
  Vehicle vehicle(7);
  Diagnosis learned{7, {0, 1, 2}, {0, 1, Diagnosis::kUnknownAxis}};
  vehicle.drive(learned, 600.0);
  const Authority authority(learned, Vehicle::ranges());
  EXPECT_NE(authority.text({Vehicle::kInputs, Vehicle::kTargets})
                .find(": surge 1.00, sway 1.00, rdot 1.00 of nominal left"),
            std::string::npos)
      << authority.text({Vehicle::kInputs, Vehicle::kTargets});
}

TEST(Authority, RefusesRangesThatAreNone) {
  Vehicle vehicle(6);
  Diagnosis learned = Vehicle::diagnosis();
  vehicle.drive(learned, 400.0);
  EXPECT_EQ(message_of<InputError>([&] {
              const Authority no(learned, {{0, -1.0, 1.0}});
            }),
            "ranges: input 0 is no thruster");
  EXPECT_EQ(message_of<InputError>([&] {
              const Authority no(learned, {{3, 1100.0, 1900.0}});
            }),
            "ranges: have to contain 0, the command at rest, and more");
  EXPECT_EQ(message_of<InputError>([&] { const Authority no(learned, {}); }),
            "ranges: have to name a thruster or more");
  EXPECT_EQ(message_of<InputError>([&] {
              const Authority no(learned, {{3, -4.0, 4.0}, {4, -4.0, 4.0}, {3, -2.0, 2.0}});
            }),
            "ranges: name input 3 twice");
}

}  // namespace
}  // namespace kelpie::authority_test
