// SPDX-License-Identifier: Apache-2.0
#include "lab/reckoning.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/quantile.hpp"
#include "simulator/scenario_file.hpp"
#include "simulator/simulation.hpp"
#include "study/simulated_log.hpp"

namespace kelpie::reckoning_test {
namespace {

using namespace lab;

log::Dataset simulated(double seconds) {
  simulator::Scenario scenario = simulator::read_scenario(std::filesystem::path(KELPIE_SOURCE_DIR) /
                                                          "scenarios" / "small.toml");
  scenario.phases.front().duration_s = seconds;
  const log::Table table = study::log_table(simulator::simulate(scenario), "simulated");
  return log::make_dataset(table, log::guess_roles(table, {}));
}

const NavigatorScore& score_of(const ReckoningResult& result, const std::string& name) {
  return *std::ranges::find(result.scores, name, &NavigatorScore::name);
}

double median_error(const NavigatorScore& score) {
  std::vector<double> errors = score.outages.front().errors;
  return quantile(errors, 0.5);
}

// A simulated log of the very terms that the model has: who holds the velocity is far behind, and
// every outage that fits into the held-out rows is counted, for everyone alike.
TEST(Reckoning, TakesEveryNavigatorThroughTheSameOutages) {
  const log::Dataset data = simulated(300.0);
  ReckoningPlan plan;
  plan.outages_s = {10.0, 400.0};
  plan.settings.practice_s = 0.0;
  plan.settings.current_m_s = 0.0;
  const ReckoningResult result =
      measure_reckoning(data, study::make_split(data, study::parse_split("tail", 1)), plan);
  ASSERT_EQ(result.scores.size(), 6U);
  for (const NavigatorScore& score : result.scores) {
    EXPECT_EQ(score.outages[0].errors.size(), result.scores[0].outages[0].errors.size());
    EXPECT_TRUE(score.outages[1].errors.empty());  // longer than the rows held out
  }
  const auto json = nlohmann::json::parse(reckoning_json({result}));
  const auto median = [&](std::size_t i) {
    return json["logs"][0]["navigators"][i]["outages"][0]["median"].get<double>();
  };
  EXPECT_EQ(json["logs"][0]["navigators"][4]["name"], "velocity held");
  EXPECT_LT(median(0), 0.2 * median(4));
  EXPECT_EQ(json["logs"][0]["navigators"][0]["outages"][1]["median"], nullptr);
  EXPECT_NE(reckoning_table({result}).find("kelpie"), std::string::npos);
}

// Learned while driving: outages after five minutes only, by a model of the rows before. An IMU
// with a tenth of a degree of tilt is far off after half a minute.
TEST(Reckoning, LearnsWhileDriving) {
  const log::Dataset data = simulated(600.0);
  ReckoningPlan plan;
  plan.outages_s = {30.0};
  const ReckoningResult result = measure_live_reckoning(data, plan);
  const NavigatorScore& kelpie = score_of(result, "kelpie");
  EXPECT_GE(kelpie.outages.front().errors.size(), 15U);
  EXPECT_LE(kelpie.outages.front().errors.size(), 20U);  // 300 s, a start every 15 s
  EXPECT_LT(median_error(kelpie), 0.1 * median_error(score_of(result, "velocity held")));
  EXPECT_LT(median_error(kelpie), 0.1 * median_error(score_of(result, "IMU alone")));
}

// A log that fails in disguise is found within a second, and costs no more than silence.
TEST(Reckoning, FindsZerosAndFrozenValues) {
  const log::Dataset data = simulated(600.0);
  ReckoningPlan plan;
  plan.outages_s = {20.0};
  const double silent = median_error(score_of(measure_live_reckoning(data, plan), "kelpie"));
  for (const OutageKind kind : {OutageKind::zeros, OutageKind::frozen}) {
    plan.kind = kind;
    const ReckoningResult result = measure_live_reckoning(data, plan);
    const NavigatorScore& kelpie = score_of(result, "kelpie");
    ASSERT_FALSE(kelpie.outages.front().found_s.empty());
    EXPECT_LE(std::ranges::max(kelpie.outages.front().found_s), 1.0);
    EXPECT_LT(median_error(kelpie), 2.0 * silent + 1e-3);
  }
}

}  // namespace
}  // namespace kelpie::reckoning_test
