// SPDX-License-Identifier: Apache-2.0
// What a model does with numbers that are none, spans of another size, and two threads at once.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <thread>

#include "kelpie/core/error.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/model/shared_model.hpp"
#include "kelpie/model/stored_past_model.hpp"
#include "kelpie/model/trained_model.hpp"
#include "kelpie/svr/resources.hpp"
#include "kelpie/vehicle/diagnosis.hpp"
#include "model/planar_drive.hpp"
#include "support.hpp"
#include "vehicle_stream.hpp"

namespace kelpie::bad_calls_test {
namespace {

using testing::Drive;
using testing::message_of;
using testing::PlanarDrive;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

DynamicsModel fresh(const Drive& drive) {
  return {drive.inputs, drive.targets, ModelSettings::from_preset("small", 2)};
}

DynamicsModel taught(const Drive& drive) {
  DynamicsModel model = fresh(drive);
  for (std::size_t i = 0; i < drive.x.size(); ++i) {
    model.update(drive.x[i], drive.y[i], 0.1 * static_cast<double>(i));
  }
  return model;
}

// The three ways to ask, of a model of any kind.
struct Doors {
  std::function<void(std::span<const double>, std::span<double>)> predict;
  std::function<void(std::span<const double>, std::span<Prediction>)> assess;
  std::function<void(std::span<const double>, std::span<double>, std::span<double>)> slopes;
};

template <typename Model>
Doors doors_of(const Model& model) {
  return {[&](auto x, auto y) { model.predict(x, y); },
          [&](auto x, auto y) { model.predict(x, y); },
          [&](auto x, auto y, auto j) { model.predict_with_jacobian(x, y, j); }};
}

// Of all kinds of models, those without a model in service too.
class BadCalls : public ::testing::Test {
 protected:
  void at_every_door(const std::function<void(const Doors&)>& look) const {
    for (const Doors& doors :
         {doors_of(fresh_), doors_of(taught_), doors_of(trained_), doors_of(shared_)}) {
      look(doors);
    }
  }

  const Drive drive_ = testing::drive(21, 300);
  const DynamicsModel fresh_ = fresh(drive_);
  const DynamicsModel taught_ = taught(drive_);
  const TrainedModel trained_ = taught_.trained();
  const SharedModel shared_{taught_};
};

TEST_F(BadCalls, OfANumberThatIsNoneNothingIsKnown) {
  for (const double none : {kNan, kInfinity, -kInfinity}) {
    const std::array x{0.1, none};
    at_every_door([&](const Doors& doors) {
      std::array<double, 2> y{};
      doors.predict(x, y);
      EXPECT_TRUE(std::isnan(y[0]) && std::isnan(y[1]));
      std::array<double, 4> jacobian{};
      doors.slopes(x, y, jacobian);
      EXPECT_TRUE(std::ranges::all_of(y, [](double v) { return std::isnan(v); }));
      EXPECT_TRUE(std::ranges::all_of(jacobian, [](double v) { return std::isnan(v); }));
      std::array<Prediction, 2> p;
      doors.assess(x, p);
      EXPECT_TRUE(std::isnan(p[1].value));
      EXPECT_EQ(p[1].upper, kInfinity);
      EXPECT_EQ(p[1].novelty, 1.0);
    });
  }
}

TEST_F(BadCalls, AnotherSizeIsRefusedAndNothingWritten) {
  at_every_door([&](const Doors& doors) {
    std::array<double, 2> y{7.0, 7.0};
    std::array<double, 4> jacobian{7.0, 7.0, 7.0, 7.0};
    std::array<Prediction, 2> p;
    const std::array x{0.1, 0.2};
    const std::span<const double> one = std::span(x).first(1);
    EXPECT_EQ(message_of<InputError>([&] { doors.predict(one, y); }),
              "x: has 1 values; it has to have 2");
    EXPECT_EQ(message_of<InputError>([&] { doors.predict(x, std::span(y).first(1)); }),
              "y: has 1 values; it has to have 2");
    EXPECT_THROW(doors.assess(one, p), InputError);
    EXPECT_THROW(doors.assess(x, std::span(p).first(1)), InputError);
    EXPECT_THROW(doors.slopes(x, y, std::span(jacobian).first(3)), InputError);
    EXPECT_THROW(doors.slopes(x, std::span(y).first(1), jacobian), InputError);
    EXPECT_EQ(y[0], 7.0);
  });
}

TEST_F(BadCalls, ASampleOfAnotherSizeIsRefusedAndLeavesTheModelAlone) {
  DynamicsModel model = taught(drive_);
  const std::string before = model.save();
  const std::array<double, 3> three{};
  EXPECT_EQ(message_of<InputError>([&] { model.update(three, drive_.y[0], 1e3); }),
            "x: has 3 values; it has to have 2");
  EXPECT_EQ(message_of<InputError>([&] { model.update(drive_.x[0], three, 1e3); }),
            "y: has 3 values; it has to have 2");
  EXPECT_EQ(model.save(), before);
}

// The writer is in the middle of an update, by its own word.
TEST_F(BadCalls, WhoComesInDuringAnUpdateIsToldSo) {
  DynamicsModel model = taught(drive_);
  std::array<double, 2> y{};
  const auto refused = [](const std::function<void()>& call) {
    return message_of<InputError>(call).starts_with(
        "model: is being updated while another thread uses it");
  };
  model.update(drive_.x[0], drive_.y[0], 1e3, [&](std::size_t) {
    std::thread([&] {
      EXPECT_TRUE(refused([&] { model.predict(drive_.x[0], y); }));
      EXPECT_TRUE(refused([&] { model.update(drive_.x[0], drive_.y[0], 1e3); }));
      EXPECT_TRUE(refused([&] { static_cast<void>(model.save()); }));
      EXPECT_TRUE(refused([&] { static_cast<void>(model.findings()); }));
      EXPECT_TRUE(refused([&] { static_cast<void>(model.past_models(0)); }));
      EXPECT_TRUE(refused([&] { model.limit(Budget()); }));
    }).join();
  });
  EXPECT_NO_THROW(model.predict(drive_.x[0], y));
  EXPECT_NO_THROW(model.update(drive_.x[0], drive_.y[0], 1e3 + 1.0));
}

// Run under the thread sanitizer, too: two threads that don't take turns lose calls, nothing else.
TEST_F(BadCalls, TwoThreadsAtOnceDoNoHarm) {
  DynamicsModel model = taught(drive_);
  const auto work = [&] {
    std::array<double, 2> y{};
    for (std::size_t i = 0; i < drive_.x.size(); ++i) {
      try {
        model.update(drive_.x[i], drive_.y[i], 1e3 + static_cast<double>(i));
        model.predict(drive_.x[i], y);
      } catch (const InputError&) {  // the other one was at it
      }
    }
  };
  std::thread other(work);
  work();
  other.join();
  EXPECT_TRUE(model.ready());
}

// Run under the thread sanitizer, too. Coefficients have moved, so the model in service is a sum.
TEST(SavingAModel, LeavesPredictionsToOtherThreads) {
  PlanarDrive drive;
  drive.drive(1, 2400, 0.5);
  drive.drive(2, 200, 0.5, 0.5, 1.6);
  DynamicsModel model(drive.inputs, drive.targets, ModelSettings::from_preset("default", 2));
  bool has_changed = false;
  for (std::size_t i = 0; i < drive.x.size(); ++i) {
    model.update(drive.x[i], drive.y[i], drive.t[i]);
    has_changed = has_changed || std::ranges::any_of(model.decisions(), &Decision::changed);
  }
  EXPECT_TRUE(has_changed);
  std::array<double, 2> before{};
  model.predict(drive.x.back(), before);
  std::thread other([&] {
    for (int i = 0; i < 20; ++i) {
      EXPECT_FALSE(model.save().empty());
    }
  });
  for (int i = 0; i < 20'000; ++i) {
    std::array<double, 2> now{};
    model.predict(drive.x.back(), now);
    EXPECT_EQ(now, before);
  }
  other.join();
}

TEST_F(BadCalls, AnAxisThatThereIsNotIsRefused) {
  DynamicsModel model = fresh(drive_);
  const auto refused = [](const std::function<void()>& call) {
    return message_of<InputError>(call) == "axis: 2 given; there are 2";
  };
  EXPECT_TRUE(refused([&] { static_cast<void>(model.axis(2)); }));
  EXPECT_TRUE(refused([&] { static_cast<void>(model.mechanisms(2)); }));
  EXPECT_TRUE(refused([&] { static_cast<void>(model.past_models(2)); }));
  EXPECT_TRUE(refused([&] { model.set_past_models(2, {}); }));
}

TEST_F(BadCalls, ASharedModelNeedsTwoSnapshots) {
  EXPECT_TRUE(message_of<InputError>([&] {
                const SharedModel shared(fresh(drive_), 1);
              }).starts_with("snapshots: has to be at least 2"));
}

}  // namespace
}  // namespace kelpie::bad_calls_test
