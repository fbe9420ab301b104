// SPDX-License-Identifier: Apache-2.0
// A model that begins with coefficients known beforehand.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "kelpie/core/error.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/svr/regressor.hpp"
#include "planar_drive.hpp"
#include "support.hpp"

namespace kelpie::nominal_test {
namespace {

using testing::message_of;
using testing::PlanarDrive;

constexpr double kStep = 0.25;  // seconds

using Nominal = std::array<std::vector<Coefficient>, 2>;

// PlanarDrive's own equations times `factor`.
Nominal nominal(double factor = 1.0) {
  return {{{{"u", -0.2 * factor},
            {"u*|u|", -0.6 * factor},
            {"n1*|n1|", 0.01 * factor},
            {"n2*|n2|", 0.01 * factor}},
           {{"r", -0.3 * factor},
            {"r*|r|", -0.5 * factor},
            {"n1*|n1|", 0.02 * factor},
            {"n2*|n2|", -0.02 * factor}}}};
}

DynamicsModel new_model(const std::string& learner = "posterior") {
  ModelSettings settings = ModelSettings::from_preset("default", 2);
  settings.assign("buffer", "200");
  settings.assign("learner", learner);
  const PlanarDrive names;
  return {names.inputs, names.targets, settings};
}

DynamicsModel model_with(const Nominal& known, const std::string& learner = "posterior") {
  DynamicsModel model = new_model(learner);
  for (std::size_t axis = 0; axis < known.size(); ++axis) {
    set_nominal(model, axis, known[axis]);
  }
  return model;
}

void learn(DynamicsModel& model, const PlanarDrive& drive, std::size_t from, std::size_t to) {
  for (std::size_t i = from; i < to; ++i) {
    model.update(drive.x[i], drive.y[i], drive.t[i]);
  }
}

// The lesser R² of both axes on a drive of other commands.
double r2(const DynamicsModel& model) {
  PlanarDrive drive;
  drive.drive(9, 1200, kStep);
  double least = 1.0;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    double mean = 0.0;
    for (const auto& y : drive.y) {
      mean += y[axis] / static_cast<double>(drive.y.size());
    }
    double spread = 0.0;
    double unexplained = 0.0;
    for (std::size_t i = 0; i < drive.x.size(); ++i) {
      std::array<double, 2> said{};
      model.predict(drive.x[i], said);
      spread += std::pow(drive.y[i][axis] - mean, 2);
      unexplained += std::pow(drive.y[i][axis] - said[axis], 2);
    }
    least = std::min(least, 1.0 - unexplained / spread);
  }
  return least;
}

PlanarDrive first_minutes() {
  PlanarDrive drive;
  drive.drive(4, 1000, kStep);
  return drive;
}

TEST(Nominal, AKnownVehicleIsPredictedFromTheFirstSamplesOn) {
  const PlanarDrive drive = first_minutes();
  DynamicsModel with = model_with(nominal());
  DynamicsModel without = new_model();
  learn(with, drive, 0, 80);
  learn(without, drive, 0, 80);
  EXPECT_GT(r2(with), 0.7);
  EXPECT_LT(r2(without), r2(with) - 0.1);
  DynamicsModel about = model_with(nominal(0.7));
  learn(about, drive, 0, 80);
  EXPECT_GT(r2(about), r2(without)) << "a thrust and a drag 30 % too small";
}

TEST(Nominal, AKnownVehicleIsPredictedBeforeTheScaleIsFinal) {
  const PlanarDrive drive = first_minutes();
  DynamicsModel with = model_with(nominal());
  DynamicsModel without = new_model();
  learn(with, drive, 0, 45);
  learn(without, drive, 0, 45);
  EXPECT_GT(r2(with), 0.2);
  EXPECT_LT(r2(without), 0.0);
}

TEST(Nominal, AWrongVehicleIsForgotten) {
  const PlanarDrive drive = first_minutes();
  DynamicsModel wrong = model_with(nominal(-1.0));
  DynamicsModel without = new_model();
  learn(wrong, drive, 0, drive.x.size());
  learn(without, drive, 0, drive.x.size());
  EXPECT_GT(r2(wrong), r2(without) - 0.01);
}

TEST(Nominal, IsPartOfTheStateUntilTheScaleIsKnownAndAfter) {
  const PlanarDrive drive = first_minutes();
  for (const std::size_t saved : {std::size_t{20}, std::size_t{150}}) {
    DynamicsModel straight = model_with(nominal());
    learn(straight, drive, 0, saved);
    DynamicsModel resumed = DynamicsModel::resume(new_model(), straight.save());
    learn(straight, drive, saved, 300);
    learn(resumed, drive, saved, 300);
    EXPECT_EQ(resumed.save(), straight.save()) << saved;
  }
}

TEST(Nominal, ALearnerAloneAndAnEmptyListChangeNothing) {
  const PlanarDrive drive = first_minutes();
  DynamicsModel alone = new_model("svr");
  DynamicsModel alone_with = model_with(nominal(), "svr");
  DynamicsModel without = new_model();
  DynamicsModel with_none = model_with({});
  for (DynamicsModel* const model : {&alone, &alone_with, &without, &with_none}) {
    learn(*model, drive, 0, 200);
  }
  std::array<double, 2> a{};
  std::array<double, 2> b{};
  for (std::size_t i = 200; i < 250; ++i) {
    alone.predict(drive.x[i], a);
    alone_with.predict(drive.x[i], b);
    EXPECT_EQ(a, b);
    without.predict(drive.x[i], a);
    with_none.predict(drive.x[i], b);
    EXPECT_EQ(a, b);
  }
}

TEST(Nominal, RefusesWhatTheModelDoesNotHave) {
  DynamicsModel model = new_model();
  const auto refusal = [&](std::size_t axis, const std::vector<Coefficient>& known) {
    return message_of<InputError>([&] { set_nominal(model, axis, known); });
  };
  EXPECT_NE(refusal(0, {{"w", 1.0}}).find("w: not a term of this model, which has u"),
            std::string::npos)
      << refusal(0, {{"w", 1.0}});
  EXPECT_NE(refusal(0, {{"u", 1.0}, {"u", 2.0}}).find("u: given twice"), std::string::npos);
  EXPECT_NE(refusal(0, {{"u", std::numeric_limits<double>::infinity()}}).find("finite"),
            std::string::npos);
  EXPECT_NE(refusal(2, {}).find("axis: 2 given; there are 2"), std::string::npos);
}

}  // namespace
}  // namespace kelpie::nominal_test
