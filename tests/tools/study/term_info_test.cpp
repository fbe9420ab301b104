// SPDX-License-Identifier: Apache-2.0
// What a stream keeps of the physics terms: coefficients look by look, units, sizes.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "kelpie/model/dynamics_model.hpp"
#include "simulator/scenario_file.hpp"
#include "simulator/simulation.hpp"
#include "study/simulated_log.hpp"
#include "study/stream.hpp"

namespace kelpie::term_info_test {
namespace {

// Two stages: nominal, then the right thruster (th2) at half its effect.
log::Dataset damaged_dagon(double seconds) {
  simulator::Scenario scenario = simulator::read_scenario(std::filesystem::path(KELPIE_SOURCE_DIR) /
                                                          "scenarios" / "paper.toml");
  scenario.phases.resize(2);
  for (simulator::Phase& phase : scenario.phases) {
    phase.duration_s = seconds;
  }
  const log::Table table = study::log_table(simulator::simulate(scenario), "simulated");
  log::Roles roles = log::guess_roles(table, {});
  roles.units = {{"u", "m/s"},     {"v", "m/s"},      {"r", "rad/s"},
                 {"th2", "rev/s"}, {"udot", "m/s^2"}, {"rdot", "rad/s^2"}};
  return log::make_dataset(table, roles);
}

study::StreamResult learned(const log::Dataset& data, const std::string& terms,
                            const std::string& buffer = "900") {
  ModelSettings settings = ModelSettings::from_preset("default", data.target_names.size());
  settings.assign("terms", terms);
  settings.assign("lambda", "10");
  settings.assign("fine", "0");
  settings.assign("c", "0.1");
  settings.assign("buffer", buffer);
  DynamicsModel model(data.input_names, data.target_names, settings);
  return study::run_stream(data, study::make_split(data, {.kind = study::SplitKind::blocks}), model,
                           {.validate_every = 100});
}

std::size_t place_of(const study::AxisResult& axis, const std::string& formula) {
  const auto found = std::ranges::find(axis.terms, formula, &study::TermInfo::formula);
  return static_cast<std::size_t>(found - axis.terms.begin());
}

// The coefficient at the last look in each of the two stages.
struct Stages {
  double nominal = 0.0;
  double damaged = 0.0;
};
Stages stages_of(const study::AxisResult& axis, const std::string& formula) {
  Stages stages;
  const std::size_t term = place_of(axis, formula);
  for (const study::ValidationPoint& point : axis.validation) {
    if (!point.coefficients.empty()) {
      (point.configuration == axis.validation.back().configuration ? stages.damaged
                                                                   : stages.nominal) =
          point.coefficients.at(term);
    }
  }
  return stages;
}

class Coefficients : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    data = damaged_dagon(1700.0);
    result = learned(data, "fossen");
  }
  static inline log::Dataset data;
  static inline study::StreamResult result;
};

TEST(CoefficientsOfALongRun, ShowAThrusterFallToHalfItsEffectAndNoOther) {
  const study::StreamResult result = learned(damaged_dagon(5000.0), "fossen");
  for (const std::size_t axis : {0U, 2U}) {  // surge and yaw
    for (const std::string formula : {"max(th2,0)^2", "-min(th2,0)^2"}) {
      const Stages right = stages_of(result.axes[axis], formula);
      EXPECT_NEAR(right.damaged / right.nominal, 0.5, 0.075) << formula << " of axis " << axis;
    }
    for (const std::string formula : {"max(th1,0)^2", "-min(th1,0)^2"}) {
      const Stages left = stages_of(result.axes[axis], formula);
      EXPECT_NEAR(left.damaged / left.nominal, 1.0, 0.15) << formula << " of axis " << axis;
    }
  }
}

TEST_F(Coefficients, AreThereFromTheFirstModelInServiceOn) {
  ASSERT_EQ(result.axes.size(), 3U);
  for (const study::AxisResult& axis : result.axes) {
    ASSERT_EQ(axis.terms.size(), 16U);
    EXPECT_TRUE(axis.validation.back().status.ready);
    for (const study::ValidationPoint& point : axis.validation) {
      EXPECT_EQ(point.coefficients.size(), point.status.ready ? 16U : 0U) << point.samples;
    }
    EXPECT_EQ(axis.validation.front().samples, 100U);
    EXPECT_TRUE(axis.validation.front().status.ready);
  }
}

TEST_F(Coefficients, HaveUnitsWhereThoseOfTheColumnsAreGiven) {
  const study::AxisResult& surge = result.axes[0];
  EXPECT_EQ(surge.unit, "m s^-2");
  EXPECT_EQ(surge.terms[place_of(surge, "u")].unit, "s^-1");
  EXPECT_EQ(surge.terms[place_of(surge, "u*|u|")].unit, "m^-1");
  EXPECT_EQ(surge.terms[place_of(surge, "v*r")].unit, "rad^-1");
  EXPECT_EQ(surge.terms[place_of(surge, "-min(th2,0)^2")].unit, "m rev^-2");
  EXPECT_EQ(surge.terms[place_of(surge, "max(th3,0)^2")].unit, "");  // of th3 none is given
  EXPECT_EQ(result.axes[1].unit, "");                                // nor of vdot
  EXPECT_EQ(result.axes[1].terms[0].unit, "");
}

TEST_F(Coefficients, ComeWithTheTermsUsualSize) {
  const study::Split split = study::make_split(data, {.kind = study::SplitKind::blocks});
  double sum = 0.0;
  for (const std::size_t row : split.training) {
    sum += std::pow(data.input(row)[0], 4);
  }
  const study::AxisResult& surge = result.axes[0];
  EXPECT_NEAR(surge.terms[place_of(surge, "u*|u|")].rms,
              std::sqrt(sum / static_cast<double>(split.training.size())), 1e-12);
}

TEST_F(Coefficients, OfALearnerWithoutTermsAreNone) {
  const study::StreamResult without = learned(data, "none", "60");
  ASSERT_EQ(without.axes.size(), 3U);
  for (const study::AxisResult& axis : without.axes) {
    EXPECT_TRUE(axis.terms.empty());
    EXPECT_TRUE(axis.validation.back().status.ready);
    EXPECT_TRUE(axis.validation.back().coefficients.empty());
  }
}

}  // namespace
}  // namespace kelpie::term_info_test
