// SPDX-License-Identifier: Apache-2.0
#include "report/identification_report.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "chart/markup_check.hpp"
#include "core/text.hpp"
#include "report/verdicts.hpp"

namespace kelpie::identification_report_test {
namespace {

study::Identification found_nothing() {
  study::Identification found;
  found.source = "logs/<log>.csv";
  found.targets = {"udot", "vdot", "rdot"};
  return found;
}

TEST(IdentificationReport, WithoutParametersOneSentenceSaysWhy) {
  study::Identification found = found_nothing();
  found.planar.parameters = {{.name = "surge_inertia", .value = NAN}};
  const std::string page = report::identification_html(found);
  EXPECT_EQ(take_apart(page).fault, "");
  EXPECT_NE(page.find("No parameter was identified: the log does not tell"), std::string::npos);
  EXPECT_EQ(page.find("<section"), std::string::npos) << "no page of dashes";
}

TEST(IdentificationReport, IntervalsAreBarsOnAScaleOfTheValue) {
  study::Identification found = found_nothing();
  found.planar.parameters = {
      {.name = "sure", .value = 2.0, .error = 0.02, .state = ParameterState::identified},
      {.name = "unsure", .value = -2.0, .error = 9.0, .state = ParameterState::identified}};
  found.planar.covariance = Matrix(2, 2);
  const std::string page = report::identification_html(found);
  EXPECT_EQ(take_apart(page).fault, "");
  EXPECT_NE(page.find("2 of 2 parameters identified."), std::string::npos);
  EXPECT_NE(page.find("left:49."), std::string::npos) << "around the middle";
  EXPECT_NE(page.find("left:0.0%;width:100.0%"), std::string::npos) << "cut at both ends";
}

TEST(IdentificationReport, UnitsAreAsPeopleWriteThem) {
  study::Identification found = found_nothing();
  found.scale = study::ScaleSource::thrust;
  found.speed_units = {"rev s^-1"};
  found.planar.parameters.assign(
      PlanarPlace::thrusters + 1,
      {.name = "one", .value = 2.0, .error = 0.1, .state = ParameterState::identified});
  found.planar.covariance = Matrix(found.planar.parameters.size(), found.planar.parameters.size());
  const std::string page = report::identification_html(found);
  EXPECT_NE(page.find("N/(rev/s)²"), std::string::npos);
  EXPECT_NE(page.find("N s²/m²"), std::string::npos);
  EXPECT_EQ(page.find("^2"), std::string::npos);
}

bool remarks_on(const study::Identification& found, const std::string& words) {
  return join_text(report::identification_remarks(found), "\n").find(words) != std::string::npos;
}

// A battery that sags has misfit 7.88, and R² of 0.94.
TEST(IdentificationReport, AMisfitFarFromChanceIsAWarning) {
  study::Identification found = found_nothing();
  found.planar.parameters = {
      {.name = "sure", .value = 2.0, .error = 0.02, .state = ParameterState::identified}};
  found.planar.covariance = Matrix(1, 1);
  found.planar.misfit = 2.99;
  EXPECT_FALSE(remarks_on(found, "misfit"));
  found.planar.misfit = 7.88;
  EXPECT_TRUE(remarks_on(found, "WARNING: misfit 7.9, where noise alone gives 1"));
  EXPECT_TRUE(remarks_on(found, "intervals are too narrow"));
  EXPECT_TRUE(remarks_on(found, "a battery that sags, a dead band"));
  EXPECT_NE(report::identification_verdict(found).find("WARNING: misfit 7.9"), std::string::npos);
  EXPECT_NE(report::identification_html(found).find(
                "1 of 1 parameters identified, with intervals that are too narrow (misfit 7.9)."),
            std::string::npos);
  found.of_poses = true;  // counts errors that last, which intervals count, too
  EXPECT_FALSE(remarks_on(found, "misfit"));
}

TEST(IdentificationReport, FinsOfTheLogAreToldToBeMissing) {
  study::Identification found = found_nothing();
  EXPECT_FALSE(remarks_on(found, "fin"));
  found.fins = {"rudder"};
  EXPECT_TRUE(remarks_on(found, "WARNING: rudder is a fin by its name"));
}

}  // namespace
}  // namespace kelpie::identification_report_test
