// SPDX-License-Identifier: Apache-2.0
#include "web/metrics.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace kelpie::metrics_test {
namespace {

live::Health some_health(const std::string& name) {
  live::Health health;
  health.rows = 12;
  health.transport.lost = 2;
  health.learner.is_paused = true;
  health.learner.median_delay_ms = 500.0;
  health.reckoning.current_speed = 0.25;
  health.learner.thrusters = {{.name = name, .lower = 0.75}};
  health.topics.push_back({.name = name, .refused = "no", .messages = 3});
  health.sources.push_back({.name = name,
                            .from = name,
                            .silent_s = std::numeric_limits<double>::infinity(),
                            .is_stuck = true});
  live::AxisHealth& axis = health.learner.axes.emplace_back();
  axis.name = name;
  axis.r2 = 0.5;
  axis.coefficients.push_back({.term = name, .value = -1e-7});
  return health;
}

// What Prometheus' text format allows; a name once, described before its values.
void expect_format(const std::string& text) {
  const std::regex comment("# (HELP|TYPE) (kelpie_[a-z0-9_]+) (.+)");
  const std::regex value(
      "(kelpie_[a-z0-9_]+)(\\{([a-z]+=\"([^\"\\\\]|\\\\[\\\\\"n])*\",?)+\\})? "
      "(NaN|[+-]Inf|-?[0-9.e+-]+)");
  std::istringstream lines(text);
  std::set<std::string> names;
  std::set<std::string> series;
  std::string current;
  for (std::string line; std::getline(lines, line);) {
    std::smatch found;
    if (std::regex_match(line, found, comment)) {
      if (found[1] == "HELP") {
        EXPECT_TRUE(names.insert(found[2]).second) << line;
        current = found[2];
      }
      EXPECT_EQ(found[2], current);
    } else {
      ASSERT_TRUE(std::regex_match(line, found, value)) << line;
      EXPECT_EQ(found[1], current) << line;
      EXPECT_TRUE(series.insert(line.substr(0, line.rfind(' '))).second) << line;
    }
  }
  EXPECT_TRUE(text.ends_with('\n'));
}

TEST(Metrics, AreWhatPrometheusReads) {
  const std::string text = web::metrics_text(some_health("u"));
  expect_format(text);
  for (const char* const line :
       {"kelpie_rows_total 12\n", "# TYPE kelpie_rows_total counter\n",
        "kelpie_axis_r2{axis=\"u\",predictor=\"model\"} 0.5\n",
        "kelpie_axis_r2{axis=\"u\",predictor=\"mean\"} NaN\n",
        "kelpie_axis_coefficient{axis=\"u\",term=\"u\"} -1e-07\n",
        "kelpie_signal_silent_seconds{signal=\"u\"} +Inf\n",
        "kelpie_topic_refused{topic=\"u\"} 1\n", "kelpie_messages_lost_total 2\n",
        "kelpie_current_speed 0.25\n", "kelpie_current_direction_degrees NaN\n",
        "kelpie_learning_paused 1\n", "kelpie_learning_frozen 1\n",
        "kelpie_row_delay_median_seconds 0.5\n", "kelpie_axis_outliers_total{axis=\"u\"} 0\n",
        "kelpie_thruster_share{thruster=\"u\",bound=\"lower\"} 0.75\n",
        "kelpie_signal_faults_total{signal=\"u\",kind=\"late\"} 0\n",
        "kelpie_signal_info{signal=\"u\",from=\"u\"} 1\n"}) {
    EXPECT_NE(text.find(line), std::string::npos) << line << text;
  }
}

TEST(Metrics, NamesDoNoHarm) {
  const std::string evil = "a\"} 1\nkelpie_up{x=\"\\\r\xff\xe2\x80\xa8";
  const std::string text = web::metrics_text(some_health(evil));
  expect_format(text);
  EXPECT_NE(text.find("a\\\"} 1\xef\xbf\xbdkelpie_up{x=\\\"\\\\"), std::string::npos) << text;
}

}  // namespace
}  // namespace kelpie::metrics_test
