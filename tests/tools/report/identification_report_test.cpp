// SPDX-License-Identifier: Apache-2.0
#include "report/identification_report.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "chart/markup_check.hpp"

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

}  // namespace
}  // namespace kelpie::identification_report_test
