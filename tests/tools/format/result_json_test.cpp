// SPDX-License-Identifier: Apache-2.0
#include "format/result_json.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <vector>

#include "report/synthetic.hpp"

namespace kelpie::result_json_test {
namespace {

using Json = nlohmann::json;

Json parsed(const study::StreamResult& result) {
  return Json::parse(format::result_json(result));
}

// All keys of all levels but the settings, whose names are the user's.
void collect_keys(const Json& json, std::set<std::string>& keys) {
  for (const auto& [key, value] : json.items()) {
    if (json.is_object()) {
      keys.insert(key);
    }
    if (key != "settings" && value.is_structured()) {
      collect_keys(value, keys);
    }
  }
}

TEST(ResultJson, EveryKeyIsDocumented) {
  const std::ifstream file(std::string(KELPIE_SOURCE_DIR) + "/docs/reference/files.md");
  std::stringstream text;
  text << file.rdbuf();
  std::set<std::string> keys;
  collect_keys(parsed(synthetic::stream_with_terms(2)), keys);
  EXPECT_GT(keys.size(), 40U);
  for (const std::string& key : keys) {
    EXPECT_NE(text.str().find("| `" + key + "` |"), std::string::npos) << key;
  }
}

TEST(ResultJson, SaysWhatTheStreamWas) {
  const study::StreamResult result = synthetic::stream(3);
  const Json json = parsed(result);
  EXPECT_EQ(json["format"], "kelpie-result");
  EXPECT_EQ(json["version"], 1);
  EXPECT_EQ(json["dataset"]["rows"], result.rows_read);
  EXPECT_EQ(json["dataset"]["inputs"].size(), 6U);
  EXPECT_EQ(json["held_out_rows"], 500);
  EXPECT_EQ(json["interrupted"], false);
  ASSERT_EQ(json["axes"].size(), 3U);
  const Json& axis = json["axes"][1];
  EXPECT_EQ(axis["name"], "axis1");
  EXPECT_EQ(axis["r2"]["min_after_1000"], 0.853);
  EXPECT_EQ(axis["decisions"]["gate_explained"], 500);
  EXPECT_EQ(axis["validation"]["samples"].size(), 40U);
  EXPECT_EQ(axis["validation"]["samples"].back(), 2000);
  EXPECT_EQ(axis["validation"]["r2"].size(), axis["validation"]["time_s"].size());
}

TEST(ResultJson, SaysWhatBecameOfTheVehicle) {
  const Json diagnosis = parsed(synthetic::stream_with_terms(3))["diagnosis"];
  EXPECT_TRUE(diagnosis["why_not"].is_null());
  const Json& finding = diagnosis["findings"][0];
  EXPECT_EQ(finding["state"], "named");
  EXPECT_EQ(finding["text"], "th2 gives 48 % of its thrust (41 to 55 %)");
  ASSERT_EQ(finding["causes"].size(), 1U);
  EXPECT_EQ(finding["causes"][0]["column"], "th2");
  EXPECT_EQ(finding["causes"][0]["lower"], 0.41);
  EXPECT_TRUE(finding["rival"]["column"].is_null());
  EXPECT_EQ(diagnosis["health"][0]["column"], "th1");
}

TEST(ResultJson, QuantilesOfTimesAreInterpolated) {
  study::StreamResult result = synthetic::stream(1);
  std::vector<double>& times = result.axes.front().update_us;
  times.resize(200);
  for (std::size_t i = 0; i < times.size(); ++i) {
    times[i] = static_cast<double>(times.size() - i);
  }
  const Json update = parsed(result)["axes"][0]["update_us"];
  EXPECT_EQ(update["median"], 100.5);
  EXPECT_NEAR(update["p99"].get<double>(), 198.01, 1e-9);
  EXPECT_EQ(update["max"], 200.0);
}

TEST(ResultJson, SettingsKeepTheirTypes) {
  study::StreamResult result = synthetic::stream(1);
  result.settings = {{"buffer", "900"},  {"C", "1e2"},  {"gamma", "0.1, 0.25,5"},
                     {"solver", "path"}, {"empty", ""}, {"mixed", "1,two"},
                     {"limit", "inf"}};
  const Json settings = parsed(result)["settings"];
  EXPECT_TRUE(settings["buffer"].is_number_integer());
  EXPECT_EQ(settings["C"], 100.0);
  EXPECT_EQ(settings["gamma"], Json::parse("[0.1, 0.25, 5]"));
  EXPECT_EQ(settings["solver"], "path");
  EXPECT_EQ(settings["empty"], "");
  EXPECT_EQ(settings["mixed"], "1,two");
  EXPECT_EQ(settings["limit"], "inf");
}

TEST(ResultJson, WhatWasNotMeasuredIsNull) {
  const Json axis = parsed(synthetic::stopped_at_once())["axes"][0];
  EXPECT_TRUE(axis["r2"]["final"].is_null());
  EXPECT_TRUE(axis["r2"]["min_after_1000"].is_null());
  EXPECT_TRUE(axis["kkt_gap"].is_null());
  EXPECT_TRUE(axis["validation"]["r2"].empty());
  study::StreamResult result = synthetic::stream(1);
  result.axes.front().update_us.clear();
  result.axes.front().validation.front().status.ready = false;
  const Json other = parsed(result)["axes"][0];
  EXPECT_TRUE(other["update_us"]["p99"].is_null());
  EXPECT_TRUE(other["validation"]["r2"][0].is_null());
  EXPECT_TRUE(other["validation"]["r2"][1].is_number());
}

TEST(ResultJson, CoefficientsComeWithTheirSeries) {
  study::StreamResult result = synthetic::stream_with_terms(1);
  result.axes.front().terms[0].unit = "";
  const Json axis = parsed(result)["axes"][0];
  EXPECT_EQ(axis["unit"], "m s^-2");
  const Json& coefficients = axis["coefficients"];
  EXPECT_EQ(coefficients["terms"], Json::parse(R"(["u*|u|", "max(th1,0)^2"])"));
  EXPECT_EQ(coefficients["units"], Json::parse(R"([null, "m rev^-2"])"));
  EXPECT_EQ(coefficients["term_rms"], Json::parse("[0.25, 40.0]"));
  EXPECT_EQ(coefficients["final"], Json::parse("[-0.8, 0.001]"));
  ASSERT_EQ(coefficients["values"].size(), 2U);  // one array per term
  for (const std::string key : {"samples", "time_s", "configuration"}) {
    EXPECT_EQ(coefficients[key].size(), 38U) << key;  // of 40 looks, two before there was a model
  }
  EXPECT_EQ(coefficients["values"][1].size(), 38U);
  EXPECT_EQ(coefficients["errors"][1].size(), 38U);
  EXPECT_EQ(coefficients["errors"][0][37], 0.05);
  EXPECT_EQ(coefficients["samples"][0], 150);
  EXPECT_EQ(coefficients["values"][1][0], 0.002);
  EXPECT_EQ(coefficients["values"][1][37], 0.001);
  EXPECT_EQ(coefficients["configuration"][37], 2);
}

TEST(ResultJson, WithoutTermsThereAreNoCoefficients) {
  const Json axis = parsed(synthetic::stream(1))["axes"][0];
  EXPECT_TRUE(axis["coefficients"].is_null());
  EXPECT_TRUE(axis["unit"].is_null());
}

TEST(ResultJson, EveryTotalIsThere) {
  study::StreamResult result = synthetic::stream(1);
  Tally& tally = result.axes.front().status.tally;
  tally = {.accepted = 1,
           .explained = 2,
           .duplicate = 3,
           .invalid = 4,
           .implausible = 17,
           .outliers = 5,
           .forgotten = 6,
           .released = 7,
           .rejected_by_tolerance = 8,
           .crowded_out = 9,
           .unfinished = 10,
           .fallbacks = 11,
           .changes = 13,
           .recalls = 14,
           .withdrawn = 16};
  // The names are what others' programs read.
  EXPECT_EQ(parsed(result)["axes"][0]["decisions"],
            Json::parse(R"({"accepted": 1, "gate_explained": 2, "gate_duplicate": 3, "invalid": 4,
                            "outliers": 5, "forgotten": 6, "released": 7, "unserved": 8,
                            "crowded_out": 9, "unfinished": 10, "fallbacks": 11,
                            "changes": 13, "recalls": 14, "withdrawn": 16,
                            "implausible": 17})"));
}

TEST(ResultJson, TheDisturbanceHasScoreAndIntervalsOfItsOwn) {
  study::StreamResult result = synthetic::stream(1);
  EXPECT_TRUE(parsed(result)["axes"][0]["disturbance"]["intervals"].is_null());
  result.axes.front().corrected_coverage = {900, 0.901, 0.88, 0.02, 0.01};
  const Json axis = parsed(result)["axes"][0];
  EXPECT_EQ(axis["disturbance"]["prequential_r2"], 0.991);
  EXPECT_EQ(axis["disturbance"]["intervals"]["held"], 0.901);
  EXPECT_TRUE(axis["intervals"].is_null());
}

TEST(ResultJson, HostileNamesStayValidJson) {
  study::StreamResult result = synthetic::stream(1);
  result.axes.front().name = "\xff\"\n</script>";
  EXPECT_EQ(parsed(result)["axes"][0]["name"], "\uFFFD\"\n</script>");
}

}  // namespace
}  // namespace kelpie::result_json_test
