// SPDX-License-Identifier: Apache-2.0
#include "lab/bench.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "chart/wording.hpp"

namespace kelpie::bench_report_test {
namespace {

std::vector<double> counting(double from, std::size_t n, double step = 1.0) {
  std::vector<double> values;
  for (std::size_t i = 0; i < n; ++i) {
    values.push_back(from + step * static_cast<double>(i));
  }
  return values;
}

lab::BenchResult made_up() {
  lab::BenchResult result;
  result.compared = 101;
  result.block = 50;
  lab::BenchAxis& axis = result.axes.emplace_back();
  axis.stream = "somewhere/<log> with a name that is much longer than any table has room for.csv";
  axis.simulated = true;
  axis.axis = "udot";
  axis.epsilon = 0.1;
  axis.runs = {{"path", counting(50.0, 101), counting(1.0, 101), counting(90.0, 101), 2, 1e-13},
               {"path, float", counting(60.0, 101), counting(1.0, 101), {}, 0, 1e-6},
               {"SMO", counting(1500.0, 101, 10.0), counting(400.0, 101), {}, 0, 1e-3}};
  axis.libsvm_us = {30'000.0};
  axis.whole = axis.runs[0];
  axis.learner_update_us = counting(10.0, 101);
  axis.learner_predict_us = counting(1.0, 101);
  result.over_window = {{axis.stream, "udot", {225, 450, 900}, {10, 100, 200}, {10, 40, 160}}};
  result.over_inputs = {{axis.stream, "udot", {3}, {100}, {1000}}};
  result.kernel = {900, 6, 1.5, 9.0, 2.0};
  result.model.thread_us = counting(450.0, 101);
  result.model.wall_us = counting(30'000.0, 101);
  result.memory = {900, 6, 14'300'000, 11'000'000, 6'800'000};
  return result;
}

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(BenchReport, TheTableHasTheFiguresAndKeepsToTheTerminal) {
  const std::string table = lab::bench_table(made_up());
  // Medians 100, 2000 and 30,000; p99 of 101 values is the hundredth.
  for (const char* const part : {"20.0 ×", "300 ×", "149 µs", "(simulation)", "14.3 MB", "6.0 ×"}) {
    EXPECT_TRUE(says(table, part)) << part << "\n" << table;
  }
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(chart::code_points(line), 100U) << line;
  }
}

// From 450 on the path's time doubles with the window, SMO's quadruples; what is before doesn't
// count.
TEST(BenchReport, FitsTheGrowthFromTheSettledWindowOn) {
  const std::string table = lab::bench_table(made_up());
  EXPECT_TRUE(says(table, "1.00")) << table;
  EXPECT_TRUE(says(table, "2.00")) << table;
}

TEST(BenchReport, AnEmptyMeasurementHasATableAndAJsonToo) {
  lab::BenchResult result = made_up();
  result.axes[0].libsvm_us.clear();
  result.axes[0].learner_update_us.clear();
  result.over_window.clear();
  result.over_inputs[0] = {"log.csv", "udot", {}, {}, {}};
  EXPECT_TRUE(says(lab::bench_table(result), "(simulation)"));
  EXPECT_TRUE(
      nlohmann::json::parse(lab::bench_json(result))["axes"][0]["libsvm_over_path"].is_null());
}

TEST(BenchReport, TheJsonHoldsEveryTime) {
  const auto json = nlohmann::json::parse(lab::bench_json(made_up()));
  EXPECT_EQ(json["format"], "kelpie-bench");
  const auto& axis = json["axes"][0];
  EXPECT_TRUE(axis["simulated"].get<bool>());
  EXPECT_EQ(axis["smo_over_path"], 20.0);
  EXPECT_EQ(axis["solvers"][0]["update_us"].size(), 101U);
  EXPECT_EQ(axis["solvers"][0]["us"]["p99"], 149.0);
  EXPECT_EQ(json["memory_bytes"]["path"], 14'300'000);
}

TEST(BenchReport, TheHistogramCountsEveryUpdateOnce) {
  const lab::BenchResult result = made_up();
  std::size_t below_half = 0;
  std::size_t thread = 0;
  std::size_t wall = 0;
  for (const lab::TimesBin& bin : lab::histogram_of(result.model)) {
    below_half += bin.below_us <= 500.0 ? bin.thread : 0;
    thread += bin.thread;
    wall += bin.wall;
  }
  EXPECT_EQ(below_half, 50U);  // of 450 to 550 µs
  EXPECT_EQ(thread, 101U);
  EXPECT_EQ(wall, 101U);
  const auto json = nlohmann::json::parse(lab::bench_json(result))["model"];
  EXPECT_EQ(json["histogram"][2]["below_us"], 500.0);
  EXPECT_EQ(json["histogram"][2]["thread"], 50U);
  EXPECT_TRUE(json["histogram"].back()["below_us"].is_null());
  EXPECT_TRUE(says(lab::times_table(result.model), "below 500 µs"));
}

TEST(BenchReport, TheSoakSaysWhetherItWasGood) {
  lab::SoakRun run{.updates = 1'000'000, .gap = 1e-12, .gap_allowed = 1e-6};
  EXPECT_TRUE(says(lab::soak_table({run}), "1,000,000 updates, 0 fallbacks"));
  EXPECT_TRUE(says(lab::soak_table({run}), ": good"));
  run.gap = 1e-3;
  EXPECT_TRUE(says(lab::soak_table({run}), "NOT GOOD"));
}

}  // namespace
}  // namespace kelpie::bench_report_test
