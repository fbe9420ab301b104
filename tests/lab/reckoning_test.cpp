// SPDX-License-Identifier: Apache-2.0
#include "lab/reckoning.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "study/simulated_log.hpp"
#include "vehicle/scenario_file.hpp"
#include "vehicle/simulation.hpp"

namespace kelpie::reckoning_test {
namespace {

using namespace lab;

// A simulated log of the very terms that the model has: who holds the velocity is far behind, and
// every outage that fits into the held-out rows is counted, for everyone alike.
TEST(Reckoning, TakesEveryNavigatorThroughTheSameOutages) {
  vehicle::Scenario scenario =
      vehicle::read_scenario(std::filesystem::path(KELPIE_SOURCE_DIR) / "scenarios" / "small.toml");
  scenario.phases.front().duration_s = 300.0;
  const log::Table table = study::log_table(vehicle::simulate(scenario), "simulated");
  const log::Dataset data = log::make_dataset(table, log::guess_roles(table, {}));
  ReckoningPlan plan;
  plan.outages_s = {10.0, 400.0};
  plan.settings.practice_s = 0.0;
  plan.settings.current_m_s = 0.0;
  const ReckoningResult result =
      measure_reckoning(data, study::make_split(data, study::parse_split("tail", 1)), plan);
  ASSERT_EQ(result.scores.size(), 5U);
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

}  // namespace
}  // namespace kelpie::reckoning_test
